#pragma once

#include <string>
#include <vector>

#include "model/road_state.h"
#include "road/road_network.h"

namespace sumogamma {

/// Answers, for standing agents, whether a red light may be what they wait for: the same for
/// everyone whoever drives, so it looks at lanes and signals, not at plans.
class RedLights {
 public:
  static constexpr double kLookAhead = 100.0;  ///< reach of a queue: lanes searched downstream [m]

  explicit RedLights(const RoadNetwork& network);

  /// Takes over what the signals show now. Cheap while nothing changes.
  void update(const RoadState& road);

  /// True where a link shows red that can be reached from the lane within kLookAhead without
  /// passing another signal. A walking area counts where all its signalled crossings show red, else
  /// pedestrians at a corner would always wait.
  bool ahead(LaneId lane);

 private:
  bool search(LaneId id, double room, int depth) const;

  const RoadNetwork& network_;
  RoadState shown_;
  std::vector<signed char> answer_;  ///< by lane: -1 not asked since the last change
};

}  // namespace sumogamma
