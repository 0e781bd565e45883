#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "road/road_network.h"

namespace sumogamma {

/// Lanes and places of those whom GAMMA drives, which SUMO's fcd-output has not: kept aside in a
/// file while the run goes on.
class FcdPlaces {
 public:
  /// `spool`: the file, which is deleted in the end. Throws Error naming it.
  explicit FcdPlaces(std::filesystem::path spool);
  ~FcdPlaces();
  FcdPlaces(const FcdPlaces&) = delete;
  FcdPlaces& operator=(const FcdPlaces&) = delete;

  /// The next step, by the time at which it began [ms].
  void begin_step(std::int64_t time);
  void add(std::string_view name, bool is_person, LaneId lane, double along);
  /// One who waits off the map for room: in no place of SUMO's that means anything.
  void add_waiting(std::string_view name, bool is_person);

  /// Copies SUMO's file with these lanes and places; who waits is left out. Throws Error naming the
  /// file.
  void write(const std::filesystem::path& from, const std::filesystem::path& to,
             const RoadNetwork& network, int precision);

 private:
  struct Place {
    std::int32_t agent, lane;  ///< kWaiting for who waits
    float along;
  };
  struct Head {
    std::int64_t time;
    std::int64_t count;
  };
  std::int32_t agent_of(std::string_view name, bool is_person);
  void put_step();

  std::filesystem::path spool_;
  std::FILE* file_ = nullptr;
  std::map<std::pair<bool, std::string>, std::int32_t> agents_;
  Head head_{-1, 0};
  std::vector<Place> places_;  ///< of the open step
};

}  // namespace sumogamma
