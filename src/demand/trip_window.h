#pragma once

#include "demand/type_demand.h"

namespace sumogamma {

/// Leaves out the trips that don't lead through the window, and notes how long the others are in
/// it.
void keep_trips_through(const RoadNetwork& road, const TripWindow& window, TypeDemand& demand);

}  // namespace sumogamma
