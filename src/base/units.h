#pragma once

#include <cmath>
#include <numbers>

namespace sumogamma {

inline constexpr double kPi = std::numbers::pi;

constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// The same angle in (-pi, pi] [rad]. Not finite in, not finite out.
inline double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// Heading [rad], counter-clockwise from +x, of a SUMO angle [deg], clockwise from north.
inline double heading_from_sumo(double sumo_degrees) {
  return wrap_angle(radians(90.0 - sumo_degrees));
}

/// SUMO angle in [0, 360) [deg] of a heading [rad].
inline double sumo_from_heading(double heading) {
  const double angle = std::fmod(90.0 - degrees(heading), 360.0);
  const double positive = angle < 0.0 ? angle + 360.0 : angle;
  return positive >= 360.0 ? 0.0 : positive;
}

}  // namespace sumogamma
