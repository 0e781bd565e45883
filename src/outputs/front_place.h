#pragma once

#include <optional>

#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// A place along a lane, as SUMO counts.
struct FrontPlace {
  LaneId lane = kNoLane;
  double along = 0;  ///< [m]
};

/// On which lane, and where on it, SUMO would have the front of a vehicle of this length [m] that
/// follows a path: on a lane of the road that its path is on there, on the one where its front is.
/// A front that is no further than 0.3 m beyond the edge of the lane `last` is still on that.
/// Nothing for who has no path.
std::optional<FrontPlace> front_place(const RoadNetwork& network, const RoadState& road,
                                      const Scene& scene, std::size_t row, double length,
                                      LaneId last);

}  // namespace sumogamma
