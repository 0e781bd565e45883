#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/vec2.h"

namespace sumogamma {

/// Distance of a point from a segment, which may have no length [m].
inline double distance_to_segment(const Vec2& from, const Vec2& to, const Vec2& point) {
  const Vec2 edge = to - from;
  const double length = edge.squaredNorm();
  const double t = length > 0 ? std::clamp((point - from).dot(edge) / length, 0.0, 1.0) : 0.0;
  return (point - from - t * edge).norm();
}

/// Distance of the segments a-b and c-d [m]; 0 where they cross.
inline double distance_of_segments(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto apart = [](const Vec2& from, const Vec2& to, const Vec2& p, const Vec2& q) {
    return cross(Vec2(to - from), Vec2(p - from)) * cross(Vec2(to - from), Vec2(q - from)) < 0;
  };
  if (apart(a, b, c, d) && apart(c, d, a, b)) return 0.0;
  return std::min({distance_to_segment(a, b, c), distance_to_segment(a, b, d),
                   distance_to_segment(c, d, a), distance_to_segment(c, d, b)});
}

/// A stretch of a segment, as shares of it in [0, 1].
struct Stretch {
  double from = 0, to = 0;
};

/// The stretch of the segment a-b in the box from `low` to `high` (Liang and Barsky, 1984); nothing
/// where it is outside or touches it in a point.
inline std::optional<Stretch> stretch_in_box(const Vec2& a, const Vec2& b, const Vec2& low,
                                             const Vec2& high) {
  constexpr double kAlong = 1e-12;  // so little is no way across
  Stretch stretch{0, 1};
  for (int axis = 0; axis < 2; ++axis) {
    const double d = b[axis] - a[axis];
    if (std::abs(d) < kAlong) {
      if (a[axis] < low[axis] || a[axis] > high[axis]) return std::nullopt;
      continue;
    }
    const double s = (low[axis] - a[axis]) / d, t = (high[axis] - a[axis]) / d;
    stretch.from = std::max(stretch.from, std::min(s, t));
    stretch.to = std::min(stretch.to, std::max(s, t));
  }
  if (!(stretch.from < stretch.to)) return std::nullopt;
  return stretch;
}

}  // namespace sumogamma
