#pragma once

#include <cmath>

#include "geometry/vec2.h"

namespace sumogamma {

/// (cos, sin) of an angle [rad], to 1e-15 for |angle| <= 7, by the C library beyond. A quarter of
/// the C library's price, and the same bits with each of them.
inline Vec2 rotation(double angle) {
  if (!(std::abs(angle) <= 7.0)) return {std::cos(angle), std::sin(angle)};
  // the nearest multiple of a right angle, taken off in two parts so that no digit is lost
  constexpr double kRightAngle = 1.5707963267341256, kRemainder = 6.077100506506192e-11;
  const double turns = angle * 0.6366197723675814;
  const int quarter = static_cast<int>(turns + (turns < 0 ? -0.5 : 0.5));
  const double rest = (angle - quarter * kRightAngle) - quarter * kRemainder;
  const double x = rest * rest;
  double c = x * (-1.0 / 87178291200) + 1.0 / 479001600;
  c = x * c - 1.0 / 3628800;
  c = x * c + 1.0 / 40320;
  c = x * c - 1.0 / 720;
  c = x * c + 1.0 / 24;
  c = x * c - 1.0 / 2;
  c = x * c + 1.0;
  double s = x * (-1.0 / 1307674368000) + 1.0 / 6227020800;
  s = x * s - 1.0 / 39916800;
  s = x * s + 1.0 / 362880;
  s = x * s - 1.0 / 5040;
  s = x * s + 1.0 / 120;
  s = x * s - 1.0 / 6;
  s = rest * (x * s + 1.0);
  switch (quarter & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

/// Tangent of an angle within a right angle [rad].
inline double tangent(double angle) {
  const Vec2 turned = rotation(angle);
  return turned.y() / turned.x();
}

}  // namespace sumogamma
