#pragma once

#include <optional>

#include "road/road_network.h"

namespace sumogamma {

/// A straight way over a road between junctions, from one sidewalk to the one across.
struct MidBlock {
  LaneId across = kNoLane;
  double leave = 0, enter = 0;  ///< along the sidewalk that is left, and the one across [m]
  double width = 0;             ///< from one to the other [m]
};

/// The sidewalk on the other side of a road with both directions: that of the edge which runs back
/// between the same junctions. kNoLane where there is none.
LaneId sidewalk_across(const RoadNetwork& network, LaneId sidewalk);

/// Where somebody who walks along a sidewalk between two places [m] crosses to the one across: the
/// share `draw`, in [0, 1), of the way. nullopt where either has no kerb, or junctions are nearer
/// than 15 m, the other side is further than 30 m away, not opposite or on another level, or
/// anything but the lanes of the two edges lies between.
std::optional<MidBlock> find_mid_block(const RoadNetwork& network, LaneId sidewalk, LaneId across,
                                       double from, double to, double draw);

}  // namespace sumogamma
