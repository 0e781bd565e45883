#pragma once

#include <cmath>
#include <limits>

namespace sumogamma {

/// How long until two bodies can have come nearer by `gap` [m] at the soonest [s]: they do so with
/// `speed` [m/s] at most now, and with `change` [m/s^2] more each second. Until then neither has to
/// be looked at again (conservative advancement). Infinite where nothing moves. None is negative.
inline double time_to_close(double gap, double speed, double change) {
  // the root of speed t + change t^2 / 2 = gap, written so that it holds without a change, too
  const double root = speed + std::sqrt(speed * speed + 2.0 * change * gap);
  return root > 0.0 ? 2.0 * gap / root : std::numeric_limits<double>::infinity();
}

}  // namespace sumogamma
