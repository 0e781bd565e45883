#pragma once

#include <span>
#include <vector>

#include "geometry/half_plane.h"

namespace sumogamma {

/// Answer of the program of Eq. 7.
struct ProgramResult {
  Vec2 point = Vec2::Zero();
  double violation =
      0;  ///< > 0: the soft planes have no common point; the most that one is violated by
  int binding =
      -1;  ///< index of the plane that holds the point (the last one that moved it), -1 for none
};

/// Scratch of closest_point, kept between calls so that it does not allocate.
struct ProgramScratch {
  std::vector<HalfPlane> relaxed;
  std::vector<HalfPlane> projected;
};

/// The point nearest to `target` within all half-planes and within `radius` of the origin (Eq. 7).
/// The first `hard_count` planes always hold: they must admit the null vector, and where rounding
/// leaves them no common point the null vector is the answer. Where the rest can't hold as well,
/// the answer keeps their greatest violation within 1 cm/s of the least possible and is nearest to
/// `target` among such points, which makes it continuous in its input. Planes that are not finite
/// are ignored, a target that is not finite counts as null. The result is always finite.
ProgramResult closest_point(std::span<const HalfPlane> planes, std::size_t hard_count,
                            const Vec2& target, double radius, ProgramScratch& scratch);

}  // namespace sumogamma
