#pragma once

#include <cstdint>
#include <vector>

#include "model/tick_geometry.h"
#include "traffic/lateral/lane_choice.h"
#include "traffic/recovery/reversing.h"

namespace sumogamma {

/// The rules of the road of a run: what they remember, and scratch that means nothing between
/// ticks.
struct Traffic {
  TrafficState state;
  std::uint64_t detours = 0;  ///< taken by drivers whose way was shut

  ApproachTable approaches;
  LaneChoiceWork lanes;
  std::vector<Backing> backing;
};

/// The folder's own tick, before anybody's velocity is chosen: where everybody is on its path, who
/// has lost its way, lanes and places in them, other routes, and then one RoadContext a row. Fills
/// `geometry` on the way. dt [s].
void update_traffic(const Model& model, RoadState& road, Scene& scene, double dt, Workers& workers,
                    TickGeometry& geometry, Traffic& traffic);

/// What the rules remember of a tick, once everybody has moved. dt [s].
void remember_tick(const Model& model, const RoadState& road, Scene& scene, double dt,
                   Workers& workers, const TickGeometry& geometry, Traffic& traffic);

}  // namespace sumogamma
