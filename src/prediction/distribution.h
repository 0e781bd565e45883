#pragma once

#include <span>

#include "geometry/vec2.h"

namespace sumogamma {

/// Proper scores of a cloud of samples for one point in the plane.
struct PointScore {
  double log_loss = 0;   ///< minus log of the kernel density at the truth [nat, density in 1/m^2]
  double energy = 0;     ///< energy score E|X - y| - E|X - X'| / 2 [m]: smaller is better
  double inside_50 = 0;  ///< 1 where the truth lies within the 50 % highest density region; a share
                         ///< where the border runs through its rank
  double inside_90 = 0;  ///< likewise 90 %
};

/// Kernel density with a normal kernel shaped as the samples' covariance, width after Scott
/// (n^(-1/6)), at least 1 cm. A region holds those of samples and truth that lie densest, each
/// among all others: a truth drawn like the samples is inside 50 and 90 times of a hundred, however
/// few samples there are. Precondition: two samples or more.
PointScore score_point(std::span<const Vec2> samples, const Vec2& truth);

}  // namespace sumogamma
