#pragma once

#include <optional>
#include <span>

#include "geometry/convex_polygon.h"

namespace sumogamma {

/// A rectangle: most footprints are one, and two of them take a fraction of the work of two
/// polygons.
struct OrientedBox {
  Vec2 center = Vec2::Zero();  ///< [m]
  Vec2 forward = Vec2(1, 0);   ///< unit direction of its x axis
  Vec2 half = Vec2::Zero();    ///< half length and half width [m], >= 0
};

/// The outline as a box about its own centre in body axes, if it is a rectangle along these axes.
std::optional<OrientedBox> as_box(std::span<const Vec2> body_outline);

/// Distance of two boxes along the axis that separates them best (separating axis theorem) [m]:
/// negative where they overlap, then minus the least displacement that separates them; otherwise a
/// lower bound of their distance.
double separation(const OrientedBox& a, const OrientedBox& b);

/// B - A of Eq. 3 for two boxes, relative to A's centre: the eight-sided sum of their edges, in
/// closed form. The same set as minkowski_difference gives, though with two equal normals where
/// edges are parallel.
PolygonDifference box_difference(const OrientedBox& b, const OrientedBox& a);

}  // namespace sumogamma
