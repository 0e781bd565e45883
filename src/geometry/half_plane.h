#pragma once

#include "geometry/vec2.h"

namespace sumogamma {

/// Feasible side is along `normal` (unit): (v - point) . normal >= 0.
struct HalfPlane {
  Vec2 point = Vec2::Zero();
  Vec2 normal = Vec2(1, 0);
};

/// Signed slack of v [unit of v]: negative where v violates the plane.
inline double slack(const HalfPlane& plane, const Vec2& v) {
  return (v - plane.point).dot(plane.normal);
}

}  // namespace sumogamma
