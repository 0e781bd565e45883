#include "inference/motion_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {
// what is believed of an agent before it moved
constexpr double kVelocityVariance = 4.0;  // [(m/s)^2]
constexpr double kTurningSpeed = 0.3;      // slower than this nothing turns [m/s]
constexpr double kFastestTurn = 1.5;       // [rad/s]
// the fourth difference of white noise has sqrt(70) of its deviation, a Rayleigh median 1.1774
constexpr double kFourthDifference = 8.3666 * 1.1774;

struct Transition {
  Eigen::Matrix3d step, noise;
};

Transition transition_of(const MotionNoise& noise, double dt) {
  const double keep = std::exp(-dt / noise.acceleration_time);
  const double b = noise.acceleration_time * (1.0 - keep);
  const double c = noise.acceleration_time * (dt - b);
  Transition t;
  t.step << 1, dt, c, 0, 1, b, 0, 0, keep;
  const double drift = noise.velocity_drift;
  const double jump = noise.acceleration_variance * (1.0 - keep * keep);
  t.noise.setZero();
  t.noise(0, 0) = drift * dt * dt * dt / 3 + jump * dt * dt * dt * dt / 20;
  t.noise(0, 1) = t.noise(1, 0) = drift * dt * dt / 2;
  t.noise(1, 1) = drift * dt + jump * dt * dt / 3;
  t.noise(1, 2) = t.noise(2, 1) = jump * dt / 2;
  t.noise(2, 2) = jump;
  return t;
}
}  // namespace

MotionFilter::MotionFilter(const MotionNoise& noise, double period) : period_(period) {
  const Transition t = transition_of(noise, period);
  keep_ = t.step(2, 2);
  to_velocity_ = t.step(1, 2);
  to_position_ = t.step(0, 2);
  const double square = noise.observation * noise.observation;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance(0, 0) = square;
  covariance(1, 1) = kVelocityVariance;
  covariance(2, 2) = 0.5;
  for (std::size_t k = 1; k < kMemory; ++k) {
    const Eigen::Matrix3d ahead = t.step * covariance * t.step.transpose() + t.noise;
    const Eigen::Vector3d gain = ahead.col(0) / (ahead(0, 0) + square);
    for (int i = 0; i < 3; ++i) gain_[k][static_cast<std::size_t>(i)] = gain(i);
    covariance = ahead - gain * ahead.row(0);
  }
}

MotionEstimate MotionFilter::estimate(std::span<const Vec2> position) const {
  if (position.size() > kMemory) position = position.last(kMemory);
  MotionEstimate estimate;
  if (position.empty()) return estimate;
  Vec2 place = position.front();
  for (std::size_t k = 1; k < position.size(); ++k) {
    place += estimate.velocity * period_ + estimate.acceleration * to_position_;
    estimate.velocity += estimate.acceleration * to_velocity_;
    estimate.acceleration *= keep_;
    const Vec2 innovation = position[k] - place;
    place += gain_[k][0] * innovation;
    estimate.velocity += gain_[k][1] * innovation;
    estimate.acceleration += gain_[k][2] * innovation;
  }
  const double square = estimate.velocity.squaredNorm();
  if (square > kTurningSpeed * kTurningSpeed)
    estimate.turn_rate = std::clamp(cross(estimate.velocity, estimate.acceleration) / square,
                                    -kFastestTurn, kFastestTurn);
  return estimate;
}

void ObservationNoise::add(std::span<const Vec2> position) {
  if (position.size() < 5) return;
  const Vec2* p = position.data() + position.size() - 5;
  const double difference = (p[4] - 4 * p[3] + 6 * p[2] - 4 * p[1] + p[0]).norm();
  if (kept_.size() < kKept) {
    kept_.push_back(difference / kFourthDifference);
  } else {
    kept_[next_] = difference / kFourthDifference;
    next_ = (next_ + 1) % kKept;
  }
}

void ObservationNoise::update() {
  if (kept_.size() < 10) return;
  scratch_ = kept_;
  const auto middle = scratch_.begin() + static_cast<std::ptrdiff_t>(scratch_.size() / 2);
  std::nth_element(scratch_.begin(), middle, scratch_.end());
  deviation_ = *middle;
}

}  // namespace sumogamma
