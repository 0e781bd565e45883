#pragma once

#include <span>

#include "road/path.h"

namespace sumogamma {

/// A vehicle's path that leaves its line at `from`, leads along `points` [m] and is back on it at
/// `to`, places along the path [m]. What lies on it is carried along; the room beside the points is
/// the old line's, less by as much as they are off it. Preconditions: the path has a trip; 0 <=
/// from < to <= the path's length; at least two points.
Path with_detour(const Path& path, double from, double to, std::span<const Vec2> points);

}  // namespace sumogamma
