#pragma once

#include <vector>

#include "road/road_network.h"

namespace sumogamma {

/// How much of what it can carry the end of each lane is asked for; over 1 a queue grows. `flow`:
/// vehicles/s by connection; result by lane. A lane out of which several ways lead takes the sum
/// of their shares, as shared lanes in the Highway Capacity Manual (2010, equation 19-35). A way
/// carries the saturation flow, at a signal for its share of green; where it gives way, what the
/// gaps in the flows that go first leave (Harders' formula, equation 19-32).
std::vector<double> lane_loads(const RoadNetwork& road, const std::vector<double>& flow);

}  // namespace sumogamma
