#pragma once

#include <cstdint>
#include <vector>

#include "model/constraints.h"
#include "model/model.h"
#include "model/tick_geometry.h"

namespace sumogamma {

/// Appends C of the solid things around a row: for every side of an outline or wall within reach
/// the half-plane of velocities that approach it no faster than the body can brake in what is left.
/// Hard; every plane admits the null vector. Convex and concave outlines and walls alike, because
/// each side stands for itself. The body's whole outline counts: the plane is normal to the
/// shortest way between body and side, which separates the two. A body that touches a side may only
/// leave or slide along it. `found` is scratch.
void append_obstacle_constraints(const Model& model, const Scene& scene,
                                 const TickGeometry& geometry, std::size_t row,
                                 std::vector<std::uint32_t>& found, ConstraintSet& constraints);

/// Shortest way from a segment to a convex outline about the origin.
struct Clearance {
  double distance = 0;        ///< [m]; 0 where they touch or cross
  Vec2 outward = Vec2(1, 0);  ///< unit, from the segment to the outline
};
Clearance clearance(const ConvexPolygon& outline, const Vec2& from, const Vec2& to);

}  // namespace sumogamma
