#pragma once

#include <limits>
#include <vector>

#include "road/path.h"

namespace sumogamma {

/// Cost of a lane from which the route can't be driven on.
inline constexpr double kUnreachable = std::numeric_limits<double>::infinity();

/// The cheapest way on from every lane of every edge of a route, by a dynamic program from its end
/// backwards: by edge of the route, then by lane index.
std::vector<std::vector<LaneOption>> plan_lanes(const RoadNetwork& network,
                                                const PathRequest& request);

}  // namespace sumogamma
