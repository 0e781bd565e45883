#pragma once

#include "road/path.h"

namespace sumogamma {

/// Fills path.speed_profile from lane limits and curvature (v^2 kappa <= lateral acceleration), then brakes backwards with
/// the comfortable deceleration. Curvature is Menger's over +-4 m, so that the vertices of a polyline don't count as bends.
void compute_speed_profile(const PathRequest& request, Path& path);

/// Appends the points of a line between two places on it [m], ends included; reversed where to < from.
void append_span(const Polyline& line, double from, double to, std::vector<Vec2>& points);

}  // namespace sumogamma
