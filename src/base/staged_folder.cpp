#include "base/staged_folder.h"

#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "base/error.h"

namespace sumogamma {
namespace fs = std::filesystem;

StagedFolder::StagedFolder(const fs::path& target, bool replace) {
  std::error_code code;
  target_ = fs::absolute(target).lexically_normal();
  if (!target_.has_filename()) target_ = target_.parent_path();  // "out/" is "out"
  if (fs::exists(target_) && !fs::is_directory(target_))
    throw Error(target.string(), "is a file, expected a folder to write into");
  if (fs::is_directory(target_)) {
    if (!replace && !fs::is_empty(target_, code))
      throw Error(target.string(),
                  "is not empty: give another folder, or --force to replace what stands in it");
    if (access(target_.c_str(), W_OK | X_OK) != 0)
      throw Error(target.string(), "is not writable: give a folder that is");
  }
  for (fs::path parent = target_.parent_path(); !fs::exists(parent); parent = parent.parent_path())
    made_.insert(made_.begin(), parent);
  for (const fs::path& parent : made_) {
    fs::create_directory(parent, code);
    if (code) {
      const std::string why = code.message();
      clean_up();
      throw Error(target.string(), "cannot be made (" + why + "): give a folder that can");
    }
  }
  staging_ = target_.parent_path() /
             ("." + target_.filename().string() + ".partial-" + std::to_string(getpid()));
  fs::create_directory(staging_, code);
  if (code) {
    const std::string why = code.message();
    staging_.clear();
    clean_up();
    throw Error(target.string(), "cannot be made (" + why + "): give a folder that can");
  }
}

StagedFolder::~StagedFolder() { clean_up(); }

void StagedFolder::abandon() noexcept {
  constexpr int kTries = 50;
  std::error_code code;
  for (int i = 0; i < kTries && fs::exists(staging_, code); ++i) fs::remove_all(staging_, code);
  clean_up();
}

void StagedFolder::clean_up() noexcept {
  std::error_code code;
  if (!staging_.empty()) fs::remove_all(staging_, code);
  if (committed_) return;
  // only what is still empty: remove() never takes a full folder
  std::for_each(made_.rbegin(), made_.rend(),
                [&](const fs::path& parent) { fs::remove(parent, code); });
}

void StagedFolder::commit() {
  std::error_code code;
  if (!fs::exists(target_) || fs::is_empty(target_, code)) {
    fs::rename(staging_, target_, code);
    if (code) throw Error(target_.string(), "cannot be put in place: " + code.message());
  } else {
    std::vector<fs::path> entries;
    for (const fs::directory_entry& entry : fs::directory_iterator(staging_))
      entries.push_back(entry.path());
    std::sort(entries.begin(), entries.end());
    for (const fs::path& entry : entries) {
      const fs::path place = target_ / entry.filename();
      if (fs::is_directory(place)) fs::remove_all(place, code);
      fs::rename(entry, place, code);
      if (code) throw Error(place.string(), "cannot be put in place: " + code.message());
    }
  }
  committed_ = true;
}

}  // namespace sumogamma
