#pragma once

#include <filesystem>
#include <string_view>

namespace sumogamma {

/// Replaces a file as a whole: a reader sees the old content or the new one, never half of it. A
/// target that isn't a regular file (a pipe, a device) is written through. Throws Error naming the
/// file where it can't be written.
void write_file(const std::filesystem::path& file, std::string_view content);

/// The whole content. Throws Error naming the file where it can't be read.
std::string read_file(const std::filesystem::path& file);

/// Makes the folder, and those above it, where it isn't there yet. Throws Error naming it where
/// that fails or it isn't writable.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace sumogamma
