#pragma once

#include "traffic/lateral/course.h"
#include "traffic/traffic_view.h"

namespace sumogamma {

/// Within which people walk in file [m].
inline constexpr double kFileReach = 2.5;

/// How fast somebody on foot may go, and how far aside, besides what its path allows: behind those
/// who walk the same way, at kerbs and crossings.
void set_walker_limits(const TrafficView& view, const Course& course, RoadContext& context);

}  // namespace sumogamma
