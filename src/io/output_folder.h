#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace sumogamma {

/// Holds a folder that is there against whoever else asks for it so; where the file system knows no
/// locks there is none. On the folder itself: a lock file would be left behind by who is killed.
class FolderLock {
 public:
  /// Waits until it is free.
  explicit FolderLock(const std::filesystem::path& folder);
  /// Throws Error where another `who` holds it.
  FolderLock(const std::filesystem::path& folder, std::string_view who);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// The folder that a run writes into, its own for as long as this lives. Taken away again where the
/// run ends before it wrote anything.
class OutputFolder {
 public:
  /// Makes it where it isn't there. Throws Error naming it where it can't be written, another run
  /// writes into it, or it holds what another run left and `force` is false.
  OutputFolder(std::filesystem::path folder, bool force);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::filesystem::path folder_;
  bool existed_;
  std::optional<FolderLock> lock_;
};

/// Throws Error where a folder holds this file of somebody else, unless `force`.
void require_without(const std::filesystem::path& folder, std::string_view file, bool force);

/// Does a run write into the folder now? False where it isn't there.
bool is_being_written(const std::filesystem::path& folder);

/// Throws Error where a page would replace a file that is no page.
void require_page_name(const std::filesystem::path& page);

}  // namespace sumogamma
