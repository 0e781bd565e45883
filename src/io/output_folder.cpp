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
                                     "replay.html",      "replay.png"};

int open_folder(const fs::path& folder) {
  return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

/// Does somebody else hold the folder? Else it is ours now, in this way (LOCK_EX, LOCK_SH).
bool is_held(int descriptor, int way) {
  return descriptor >= 0 && flock(descriptor, way | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : descriptor_(open_folder(folder)) {
  if (descriptor_ >= 0) flock(descriptor_, LOCK_EX);
}

FolderLock::FolderLock(const fs::path& folder, std::string_view who)
    : descriptor_(open_folder(folder)) {
  if (!is_held(descriptor_, LOCK_EX)) return;
  close(descriptor_);
  throw Error(folder.string(),
              "another " + std::string(who) + " writes into it, choose another folder");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool is_being_written(const fs::path& folder) {
  const int descriptor = open_folder(folder);
  // shared: two who only ask don't disturb each other
  const bool held = is_held(descriptor, LOCK_SH);
  if (descriptor >= 0) close(descriptor);
  return held;
}

void require_without(const fs::path& folder, std::string_view file, bool force) {
  if (force || !fs::exists(folder / file)) return;
  throw Error(folder.string(), "holds another " + std::string(file) +
                                   ", choose another folder or replace it with --force");
}

OutputFolder::OutputFolder(fs::path folder, bool force)
    : folder_(std::move(folder)), existed_(fs::exists(folder_)) {
  make_output_folder(folder_);
  lock_.emplace(folder_, "run");
  for (const char* name : kRunFiles) {
    if (!fs::exists(fs::symlink_status(folder_ / name))) continue;
    if (!force)
      throw Error(folder_.string(), "holds another run's " + std::string(name) +
                                        ", choose another folder or replace it with --force");
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
  lock_.reset();
  std::error_code not_empty;
  if (!existed_) fs::remove(folder_, not_empty);
}

void require_page_name(const fs::path& page) {
  if (fs::is_regular_file(page) && page.extension() != ".html")
    throw Error(page.string(), "is there already and no page (.html), choose another name");
}

}  // namespace sumogamma
