#pragma once

#include "demand/type_demand.h"

namespace sumogamma {

/// Seconds that an edge takes at the road's limit, which drivers keep; people on foot and on
/// bicycles at their own speed.
double edge_duration(const TypeDemand& demand, std::size_t edge);

/// Has SUMO's duarouter make routes of all drawn trips and adds those that suit their type to its
/// pool; false where it was stopped. Throws Error where the router is missing or fails.
bool route_trips(const RoadNetwork& road, const DemandRequest& request,
                 std::vector<TypeDemand>& demands, DemandReport& report);

}  // namespace sumogamma
