#pragma once

#include <filesystem>
#include <string>

namespace sumogamma {

/// A new folder among the system's temporary ones, gone with what it holds when this ends.
class ScratchFolder {
 public:
  /// Throws Error naming the folder where it can't be made.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Writes a file of this name into it.
  std::filesystem::path file(const char* name, const std::string& content) const;

 private:
  std::filesystem::path path_;
};

}  // namespace sumogamma
