#pragma once

#include "geometry/convex_polygon.h"

namespace sumogamma {

/// The way out of a velocity obstacle from the present relative velocity (Eq. 4).
struct Escape {
  Vec2 change = Vec2::Zero();  ///< u: nearest boundary point minus the relative velocity [m/s]
  Vec2 normal = Vec2(1, 0);    ///< outward unit normal of the boundary there
  bool colliding = false;      ///< the relative velocity lies inside the obstacle
  bool overlapping = false;    ///< the bodies overlap already
};

/// Which way symmetric encounters are resolved.
enum class PassingSide : std::uint8_t { Right, Left };

/// The nearest point on the boundary of VO^tau (Eqs. 3-4) from `relative_velocity` = v_A - v_B,
/// exactly. `near`: near side of B - A with the position of B seen from A, the origin not inside;
/// `horizon`: tau [s]. Where passing on either side is equally near, the given side is taken. Laws:
/// |change| is the distance to the boundary; change is along normal inside and against it outside.
Escape nearest_escape(const NearSide& near, const Vec2& relative_velocity, double horizon,
                      PassingSide side = PassingSide::Right);

/// The same, but leaving through the part of the boundary that is nearest to `intended`, the
/// relative velocity that the two would have if nobody were in their way: the line through that
/// part bounds the velocities. Where `intended` is safe, the nearest point counts as above.
Escape intended_escape(const NearSide& near, const Vec2& relative_velocity, const Vec2& intended,
                       double horizon, PassingSide side = PassingSide::Right);

/// Bodies that overlap: the nearest boundary point of (B - A) / time, so that they come apart
/// within `time` [s]. Two coinciding points have no way out: no change.
Escape overlap_escape(const PolygonDifference& difference, const Vec2& relative_velocity,
                      double time);

}  // namespace sumogamma
