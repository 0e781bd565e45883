#pragma once

#include "traffic/lateral/course.h"
#include "traffic/traffic_view.h"

namespace sumogamma {

/// How far somebody on foot with a path looks for those below [m].
double walker_reach(const TrafficView& view, const Path& path, std::size_t row);

/// How fast somebody on foot may go, and how far aside, besides what its path allows: behind those
/// who walk the same way, at kerbs and crossings.
void set_walker_limits(const TrafficView& view, const Course& course, RoadContext& context);

}  // namespace sumogamma
