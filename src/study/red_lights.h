#pragma once

#include <string>
#include <vector>

#include "road/road_network.h"
#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// Answers, for standing agents, whether a red light may be what they wait for: the same for
/// everyone whoever drives, so it looks at lanes, signals and who stands, not at plans.
class RedLights {
 public:
  static constexpr double kLookAhead = 100.0;  ///< lanes searched downstream [m]
  static constexpr double kJunction = 40.0;    ///< likewise for the tail of a queue [m]
  static constexpr double kTail = 25.0;        ///< who stands so near its begin fills a lane [m]

  explicit RedLights(const RoadNetwork& network);

  /// Takes over what the signals show now and who stands where. Cheap while nothing changes.
  void update(const RoadState& road, const Scene& scene);

  /// True where a link shows red that can be reached from the lane within kLookAhead without
  /// passing another signal, or likewise, within kJunction, a lane that the queue before such a red
  /// fills: queues of 300 m reach back over other junctions. A walking area counts where all its
  /// signalled crossings show red, else pedestrians at a corner would always wait.
  bool ahead(LaneId lane);

 private:
  bool search(LaneId id) const;
  bool search(LaneId id, double room, int depth) const;

  const RoadNetwork& network_;
  RoadState shown_;
  std::vector<LaneId> filled_;       ///< lanes that somebody who stands fills, in order
  std::vector<char> in_queue_;       ///< by lane: such a one, and the queue's head is before a red
  std::vector<signed char> answer_;  ///< by lane: -1 not asked since the last change
};

}  // namespace sumogamma
