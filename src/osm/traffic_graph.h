#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// One step out of a node along a way, in a direction that traffic may go.
struct Step {
  const MapWay* way = nullptr;
  std::size_t index = 0;  ///< of the node in the way
  int direction = 1;      ///< +1 towards the way's last node
};

/// Car ways by node, for walking along the traffic. Keeps pointers into the map.
class TrafficGraph {
 public:
  explicit TrafficGraph(const OsmMap& map);

  /// True where at least three arms meet, two of which bring traffic.
  bool is_junction(std::int64_t node) const;
  /// Ways out of the node that traffic may take.
  std::vector<Step> exits(std::int64_t node) const;
  /// First junction along the traffic, and how far it is [m]; 0 where there is none within reach.
  /// `last` is the step onto it.
  std::int64_t junction_ahead(Step step, double reach, double& distance,
                              Step* last = nullptr) const;
  /// True where a junction lies within reach [m] along any arm, whatever the direction of traffic.
  bool junction_within(std::int64_t node, double reach) const;

  bool known(std::int64_t node) const { return arms_.contains(node); }
  std::size_t arm_count(std::int64_t node) const { return arms_.at(node).size(); }
  const std::vector<Step>& arms(std::int64_t node) const { return arms_.at(node); }

 private:
  std::optional<Step> straightest_exit(std::int64_t node, std::int64_t came_from) const;
  void add(const MapWay& way, std::size_t index, int direction);

  const OsmMap& map_;
  std::map<std::int64_t, std::vector<Step>> arms_;
  std::map<std::int64_t, int> inputs_;
};

/// False where the signal or sign is known to be for the other direction of its way.
bool faces(const Tags& tags, int direction);

}  // namespace sumogamma::osm
