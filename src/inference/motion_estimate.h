#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// How a kind of agent moves and how well it is observed: the noise of the motion filter. By axis.
struct MotionNoise {
  double observation = 0.02;         ///< standard deviation of an observed position [m]
  double acceleration_variance = 1;  ///< stationary variance of the acceleration [(m/s^2)^2]
  double acceleration_time = 1;      ///< over which it forgets itself [s]
  double velocity_drift = 0.01;      ///< random walk of the velocity [(m/s)^2/s]
};

/// What an agent does now.
struct MotionEstimate {
  Vec2 velocity = Vec2::Zero();      ///< [m/s]
  Vec2 acceleration = Vec2::Zero();  ///< [m/s^2]
  double turn_rate = 0;              ///< of the velocity's direction, positive left [rad/s]
};

/// Kalman filter of position, velocity and an acceleration that forgets itself (Singer 1970), over
/// the last frames only. Its gains depend on noise and count alone, so they are computed once and
/// an estimate costs a few products a frame.
class MotionFilter {
 public:
  static constexpr std::size_t kMemory = 8;  ///< frames that an estimate looks back

  MotionFilter() = default;
  /// Precondition: all noises > 0, period > 0 [s].
  MotionFilter(const MotionNoise& noise, double period);

  /// Estimate at the last position; null for a single one. Commutes with rotations and shifts of
  /// the world.
  MotionEstimate estimate(std::span<const Vec2> position) const;

 private:
  /// Share of the innovation that goes to position, velocity and acceleration, by frames seen.
  std::array<std::array<double, 3>, kMemory> gain_{};
  double period_ = 0.4, keep_ = 1, to_velocity_ = 0, to_position_ = 0;
};

/// How noisy the recording itself is [m]: the median fourth difference of the positions seen
/// lately, which motion barely reaches. Past data alone.
class ObservationNoise {
 public:
  /// Takes in the last five positions of an agent; fewer say nothing.
  void add(std::span<const Vec2> position);
  /// Present estimate, updated once a frame after all agents [m].
  void update();
  double deviation() const { return deviation_; }
  /// As new.
  void clear() {
    kept_.clear();
    next_ = 0;
    deviation_ = kAssumed;
  }

 private:
  static constexpr std::size_t kKept = 400;
  static constexpr double kAssumed = 0.02;  // before anything was seen [m]
  std::vector<double> kept_, scratch_;
  std::size_t next_ = 0;
  double deviation_ = kAssumed;
};

}  // namespace sumogamma
