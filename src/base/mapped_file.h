#pragma once

#include <filesystem>
#include <string_view>

namespace sumogamma {

/// The bytes of a file, read without being copied; empty where it can't be read. A file that
/// shrinks meanwhile ends the process: for files that are replaced and never changed.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

}  // namespace sumogamma
