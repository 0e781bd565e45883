#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

namespace sumogamma {

/// A point [m], displacement [m] or velocity [m/s] in the plane, x east, y north.
using Vec2 = Eigen::Vector2d;

/// z component of a x b: positive where b is to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// v turned by a quarter to the left.
inline Vec2 left_of(const Vec2& v) { return {-v.y(), v.x()}; }

/// Unit vector along a heading [rad].
inline Vec2 direction_of(double heading) { return {std::cos(heading), std::sin(heading)}; }

/// Heading of v [rad]; 0 for the null vector.
inline double heading_of(const Vec2& v) { return std::atan2(v.y(), v.x()); }

/// v expressed in world axes, given in axes whose x points along `forward` (unit).
inline Vec2 from_body(const Vec2& v, const Vec2& forward) {
  return v.x() * forward + v.y() * left_of(forward);
}

/// World vector v expressed in axes whose x points along `forward` (unit).
inline Vec2 to_body(const Vec2& v, const Vec2& forward) {
  return {forward.dot(v), cross(forward, v)};
}

/// Where the lines through a along `along` and through b along `across` cross: shares of the two
/// pieces (x of the first, y of the second), in [0, 1] where that lies on them. nullopt where they
/// are parallel.
inline std::optional<Vec2> crossing_shares(const Vec2& a, const Vec2& along, const Vec2& b,
                                           const Vec2& across) {
  const double area = cross(along, across);
  if (area == 0.0) return std::nullopt;
  const Vec2 between = b - a;
  return Vec2(cross(between, across) / area, cross(between, along) / area);
}

}  // namespace sumogamma
