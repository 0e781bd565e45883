#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sumogamma {

/// A result folder that appears whole or not at all: files are written into a sibling folder, and
/// commit() moves them into place. Left without commit (error, Ctrl-C) everything that was made,
/// parents included, is removed again.
class StagedFolder {
 public:
  /// Throws Error naming `target` where it is a file, is not empty (unless `replace`), or cannot be
  /// written next to.
  explicit StagedFolder(const std::filesystem::path& target, bool replace = false);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Where to write.
  const std::filesystem::path& path() const { return staging_; }
  /// Moves all into place. With `replace` files of the same name are replaced and others stay.
  /// Throws Error.
  void commit();
  /// Removes all that was made, as leaving without commit does. For who ends the process while
  /// another thread still writes: what that one makes meanwhile is removed as far as possible.
  void abandon() noexcept;

 private:
  void clean_up() noexcept;

  std::filesystem::path target_, staging_;
  std::vector<std::filesystem::path> made_;  ///< parents that did not exist before, outermost first
  bool committed_ = false;
};

}  // namespace sumogamma
