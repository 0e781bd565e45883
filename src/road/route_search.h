#pragma once

#include <span>
#include <vector>

#include "road/road_network.h"

namespace sumogamma {

/// Time that each edge takes on an empty road [s], by EdgeId; 0 where it has no lanes.
std::vector<double> free_travel_times(const RoadNetwork& network);

/// The edges of the way that takes the least time from the end of a lane to `destination`, the
/// lane's own edge first (Dijkstra over edges). `travel_time` [s] is by EdgeId; turn-arounds are
/// left out, and so is what doesn't admit the class. Empty where no way leads there. Of equally
/// fast ways the one over smaller edge ids.
std::vector<EdgeId> fastest_route(const RoadNetwork& network, LaneId from, EdgeId destination,
                                  VehicleClassMask vehicle_class,
                                  std::span<const double> travel_time);

}  // namespace sumogamma
