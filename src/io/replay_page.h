#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sumogamma {

/// Writes one self-contained HTML page that plays a recording; it needs no network and no other
/// file. Throws Error naming the file where the recording is missing, damaged or the page can't be
/// written.
void write_replay_page(const std::filesystem::path& page, const std::filesystem::path& recording);

/// The same page without a recording: it asks whoever served it for what goes on.
std::string live_replay_page();

/// Text of bytes as RFC 4648 has it.
std::string base64(std::string_view bytes);

}  // namespace sumogamma
