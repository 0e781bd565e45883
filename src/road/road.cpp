#include "road/road.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "base/mapped_file.h"
#include "road/road_archive.h"
#include "road/sumo_net_reader.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSuffix = ".road";

/// Where the road of a network lies: whatever might change it changes its name.
std::optional<fs::path> cached_file(const fs::path& network, const RoadCache& cache) {
  std::error_code error;
  if (cache.folder.empty() || fs::file_size(network, error) < cache.least_network || error)
    return std::nullopt;
  const MappedFile program("/proc/self/exe"), file(network);
  if (program.bytes().empty() || file.bytes().empty()) return std::nullopt;
  const std::array parts{hash_of_bytes(file.bytes()), hash_of_bytes(program.bytes()),
                         hash_of_math_library()};
  const std::string_view key(reinterpret_cast<const char*>(parts.data()), sizeof parts);
  return cache.folder / (hash_text(hash_of_bytes(key)) + kSuffix);
}

/// The bytes behind their hash; nothing where it is another's, or they aren't whole.
std::optional<Road> load(const fs::path& file) {
  const MappedFile mapped(file);
  std::uint64_t hash = 0;
  if (mapped.bytes().size() < sizeof hash) return std::nullopt;
  std::memcpy(&hash, mapped.bytes().data(), sizeof hash);
  const std::string_view archive = mapped.bytes().substr(sizeof hash);
  if (hash != hash_of_bytes(archive)) return std::nullopt;
  std::error_code ignored;  // a folder that can't be written is good to read from
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  return road_of(archive);
}

/// Removes what wasn't used for longest until no more than `most` bytes are left.
void prune(const fs::path& folder, std::uintmax_t most) {
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == kSuffix)
      files.emplace_back(at->last_write_time(error), at->path());
  std::sort(files.rbegin(), files.rend());
  std::uintmax_t sum = 0;
  for (const auto& [time, file] : files) {
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) continue;  // another run has removed it
    sum += size;
    if (sum > most) fs::remove(file, error);
  }
}

/// Appears whole or not at all.
void save(const Road& road, const fs::path& file, std::uintmax_t most_kept) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  const std::string archive = archive_of(road);
  const std::uint64_t hash = hash_of_bytes(archive);
  // with the same suffix: what a run left that was ended in here is pruned, too
  fs::path staged = file;
  staged.replace_extension(std::to_string(getpid()) + kSuffix);
  {
    std::ofstream stream(staged, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(&hash), sizeof hash);
    stream.write(archive.data(), static_cast<std::streamsize>(archive.size()));
    stream.close();
    if (stream) fs::rename(staged, file, error);
    if (stream && !error) return prune(file.parent_path(), most_kept);
  }
  fs::remove(staged, error);
}

}  // namespace

Road read_road(const fs::path& file, const RoadCache& cache, Workers& workers) {
  const std::optional<fs::path> cached = cached_file(file, cache);
  if (cached)
    if (std::optional<Road> road = load(*cached)) return std::move(*road);
  Road road;
  road.network = read_sumo_net(file, workers);
  road.conflicts = build_conflict_table(road.network, workers);
  road.swept_ways = find_swept_ways(road.network, road.conflicts, workers);
  if (cached) save(road, *cached, cache.most_kept);
  return road;
}

}  // namespace sumogamma
