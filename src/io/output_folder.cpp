#include "io/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "io/output_file.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRunFiles[] = {"results.json",     "trajectories.fcd.xml.gz",
                                     "vehicles.csv.gz",  "persons.csv.gz",
                                     "vehicles.parquet", "persons.parquet",
                                     "trips.csv",        "stuck.csv",
                                     "held.csv",         "offences.csv",
                                     "collisions.csv",   "conflicts.csv",
                                     "lanes.csv",        "traffic.csv",
                                     "journeys.csv",     "replay.bin",
                                     "replay.html"};

}  // namespace

OutputFolder::OutputFolder(fs::path folder, bool force)
    : folder_(std::move(folder)), existed_(fs::exists(folder_)) {
  make_output_folder(folder_);
  // on the folder itself: a lock file would be left behind by who is killed
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(lock_);
    throw Error(folder_.string(), "another run writes into it, choose another folder");
  }
  for (const char* name : kRunFiles) {
    if (!fs::exists(fs::symlink_status(folder_ / name))) continue;
    if (!force) {
      if (lock_ >= 0) close(lock_);
      throw Error(folder_.string(), "holds another run's " + std::string(name) +
                                        ", choose another folder or replace it with --force");
    }
    // what this run may not write itself must not pass for its own; where a link leads is the
    // user's
    const std::string_view file = name;
    const bool table = file.ends_with(".csv.gz") || file.ends_with(".parquet");
    const bool stale = file.rfind("replay", 0) == 0 || file.rfind("traj", 0) == 0 || table ||
                       file == "results.json";
    if (stale && !fs::is_symlink(folder_ / name)) fs::remove(folder_ / name);
  }
}

OutputFolder::~OutputFolder() {
  if (lock_ >= 0) close(lock_);
  std::error_code not_empty;
  if (!existed_) fs::remove(folder_, not_empty);
}

bool is_being_written(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return false;
  // shared: two who only ask don't disturb each other
  const bool locked = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return locked;
}

FolderLock::FolderLock(const fs::path& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  // where the file system knows no locks there is none
  if (descriptor_ >= 0) flock(descriptor_, LOCK_EX);
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

void require_page_name(const fs::path& page) {
  if (fs::is_regular_file(page) && page.extension() != ".html")
    throw Error(page.string(), "is there already and no page (.html), choose another name");
}

}  // namespace sumogamma
