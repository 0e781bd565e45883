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

/// Distance of two boxes [m]; 0 where they overlap.
double distance(const OrientedBox& a, const OrientedBox& b);

/// B - A of Eq. 3 for two boxes, relative to A's centre, in closed form: an eight-sided polygon
/// around `center`, whose opposite edges are parallel. Edge k runs along generator k for k < 4, in
/// order of direction, and backwards along it for k + 4.
class BoxDifference {
 public:
  BoxDifference(const OrientedBox& b, const OrientedBox& a);

  /// True where A, moving at `velocity` relative to B and up to `more` faster [m/s], doesn't touch
  /// it within `time` [s] because it doesn't along the axis that separates the two best: such
  /// velocities lie outside VO^time.
  bool stays_apart(const Vec2& velocity, double time, double more = 0) const {
    return gap_ > 0 && (axis_.dot(velocity) + more) * time < gap_;
  }

  /// What the origin sees of it; edges that are parallel count one by one.
  NearSide near_side() const;

  /// All of it. The same set as minkowski_difference gives, though with equal normals where edges
  /// are parallel.
  PolygonDifference polygon() const;

 private:
  Vec2 corner(std::uint32_t k) const;

  Vec2 center_;
  std::array<Vec2, 4> half_edges_, normals_;
  std::array<double, 4> along_{},
      extents_{};             ///< of the centre along the normals, and of the polygon from there
  Vec2 axis_ = Vec2::Zero();  ///< from A to B
  double gap_ = 0;            ///< along the axis [m]; <= 0 where they overlap
};

}  // namespace sumogamma
