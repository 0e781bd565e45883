#pragma once

#include <span>

#include "geometry/vec2.h"

namespace sumogamma {

/// Proper scores of a cloud of samples for one point in the plane.
struct PointScore {
  double log_loss = 0;   ///< minus log of the kernel density at the truth [nat, density in 1/m^2]
  double energy = 0;     ///< energy score E|X - y| - E|X - X'| / 2 [m]: smaller is better
  double inside_50 = 0;  ///< 1 where the truth lies within the 50 % highest density region
  double inside_90 = 0;  ///< likewise 90 %
};

/// Kernel density with a normal kernel shaped as the samples' covariance, width after Scott
/// (n^(-1/6)), at least 1 cm. The p region is where the density exceeds that at the sample of rank
/// (1 - p), each sample's density taken without itself, so that few samples don't make the regions
/// too small. Precondition: two samples or more.
PointScore score_point(std::span<const Vec2> samples, const Vec2& truth);

}  // namespace sumogamma
