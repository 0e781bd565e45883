#pragma once

#include <cstdint>
#include <vector>

#include "traffic/lateral/lane_choice.h"
#include "traffic/recovery/reversing.h"

namespace sumogamma {

/// The rules of the road of a run: what they remember, and scratch that means nothing between
/// ticks.
struct Traffic {
  TrafficParameters parameters;
  TrafficCode code;
  TrafficState state;
  std::uint64_t detours = 0;  ///< taken by drivers whose way was shut

  ApproachTable approaches;
  Perception perception;
  WaitGraph waits;
  LaneChoiceWork lanes;
  std::vector<Backing> backing;
};

/// The folder's own tick, before anybody's velocity is chosen: where everybody is on its path, who
/// has lost its way, lanes and places in them, other routes, and then one RoadContext a row. Fills
/// tick.geometry on the way. `tick` writes into `traffic`.
void update_traffic(const TrafficTick& tick, Traffic& traffic);

/// What the rules remember of a tick, once everybody has moved.
void remember_tick(const TrafficTick& tick, Traffic& traffic);

}  // namespace sumogamma
