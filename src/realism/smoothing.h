#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// Places and their rates of change.
struct SmoothedTrack {
  std::vector<Vec2> position;  ///< [m]
  std::vector<Vec2> velocity;  ///< [m/s]
};

/// Points `period` apart [s], each replaced by the parabola of least squares through the window
/// about it: an odd number of points, as many as `window` [s] holds and at least five; at the ends
/// the last whole window's (Savitzky and Golay 1964). A parabola comes out as it is. Precondition:
/// at least three points.
SmoothedTrack smoothed(std::span<const Vec2> points, double period, double window = 1.0);

/// Value and slope at time 0 of the curve of least squares through values at `times` [s]: a
/// parabola from five points on, a line below, a standing point where there is one. Precondition:
/// at least one.
std::pair<Vec2, Vec2> value_and_slope(std::span<const double> times, std::span<const Vec2> values);

}  // namespace sumogamma
