#include "realism/motion_features.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "geometry/oriented_box.h"

namespace sumogamma {

namespace {

constexpr double kReach = 50.0;                    // of others' centres [m]
constexpr double kFarthest = 40.0, kLatest = 5.0;  // ends of the bins [m], [s]
constexpr double kSlightOverlap = 0.5;             // [m]
constexpr double kLeastClosing = 0.01;             // [m/s]
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Central differences of one row over two steps, where both sides are there and finite.
void differentiate(const double* value, std::size_t present, bool turns, double* rate) {
  for (std::size_t k = 1; k + 1 < present; ++k) {
    double change = value[k + 1] - value[k - 1];
    if (turns) change = wrap_angle(change);
    rate[k] = change / (2.0 * kScoreStep);
  }
}

/// What one body is to the pairs of a step.
struct Body {
  std::size_t row = 0;
  OrientedBox box;
  double heading = 0, speed = 0, radius = 0;
};

double signed_gap(const OrientedBox& a, const OrientedBox& b) {
  const double apart = separation(a, b);
  return apart < 0.0 ? apart : distance(a, b);
}

/// Notes what `other` is to `own` if it is ahead.
void look_ahead(const Body& own, const Body& other, double& gap, double& soonest) {
  const Vec2 offset = other.box.center - own.box.center;
  const double along = own.box.forward.dot(offset), aside = cross(own.box.forward, offset);
  const double turned = std::abs(wrap_angle(other.heading - own.heading));
  const double cosine = std::cos(turned), sine = std::sin(turned);
  const double reach = std::abs(cosine) * other.box.half.x() + sine * other.box.half.y();
  const double breadth = sine * other.box.half.x() + std::abs(cosine) * other.box.half.y();
  const double between = along - own.box.half.x() - reach;
  const double overlap = own.box.half.y() + breadth - std::abs(aside);
  if (between <= 0.0 || overlap <= 0.0 || turned >= radians(75.0)) return;
  if (turned > radians(10.0) && overlap < kSlightOverlap) return;
  gap = std::min(gap, between);
  const double closing = own.speed - other.speed * cosine;
  if (closing > kLeastClosing) soonest = std::min(soonest, between / closing);
}

class PairFeatures {
 public:
  PairFeatures(const Poses& poses, const Bodies& bodies, MotionFeatures& features)
      : poses_(poses), bodies_(bodies), features_(features) {}

  void look_at(std::size_t step) {
    gather(step);
    for (const Body& body : there_) {
      features_.nearest[body.row * Poses::kSteps + step] = kFarthest;
      features_.time_to_collision[body.row * Poses::kSteps + step] = kLatest;
      features_.gap[body.row * Poses::kSteps + step] = std::numeric_limits<double>::infinity();
    }
    for (std::size_t i = 0; i < there_.size(); ++i)
      for (std::size_t j = i + 1; j < there_.size(); ++j) meet(there_[i], there_[j], step);
  }

 private:
  void gather(std::size_t step) {
    there_.clear();
    for (std::size_t row = 0; row < poses_.rows(); ++row) {
      if (step >= bodies_.present[row]) continue;
      const std::size_t at = row * Poses::kSteps + step;
      Body body;
      body.row = row;
      body.heading = poses_.heading[at];
      const Vec2 half = 0.5 * bodies_.size[row];
      body.box = {poses_.position[at], direction_of(body.heading), half};
      body.radius = half.norm();
      if (std::isfinite(features_.speed[at])) body.speed = features_.speed[at];
      there_.push_back(body);
    }
  }

  void meet(const Body& a, const Body& b, std::size_t step) {
    const double apart = (b.box.center - a.box.center).norm();
    if (apart >= kReach) return;
    const std::size_t of_a = a.row * Poses::kSteps + step, of_b = b.row * Poses::kSteps + step;
    double &near_a = features_.nearest[of_a], &near_b = features_.nearest[of_b];
    // circles tell already that neither is the nearest
    if (apart - a.radius - b.radius < std::max(near_a, near_b)) {
      const double gap = signed_gap(a.box, b.box);
      near_a = std::min(near_a, gap);
      near_b = std::min(near_b, gap);
    }
    look_ahead(a, b, features_.gap[of_a], features_.time_to_collision[of_a]);
    look_ahead(b, a, features_.gap[of_b], features_.time_to_collision[of_b]);
  }

  const Poses& poses_;
  const Bodies& bodies_;
  MotionFeatures& features_;
  std::vector<Body> there_;
};

}  // namespace

double signed_distance(const MotionState& a, const Vec2& size_a, const MotionState& b,
                       const Vec2& size_b) {
  return signed_gap({a.position, direction_of(a.heading), 0.5 * size_a},
                    {b.position, direction_of(b.heading), 0.5 * size_b});
}

MotionFeatures features_of(const Poses& poses, const Bodies& bodies) {
  const std::size_t count = poses.rows() * Poses::kSteps;
  MotionFeatures features;
  for (std::vector<double>* values :
       {&features.speed, &features.acceleration, &features.yaw_rate, &features.yaw_acceleration,
        &features.nearest, &features.time_to_collision, &features.gap})
    values->assign(count, kNone);
  for (std::size_t row = 0; row < poses.rows(); ++row) {
    const std::size_t at = row * Poses::kSteps, present = bodies.present[row];
    for (std::size_t k = at + 1; k + 1 < at + present; ++k)
      features.speed[k] = (poses.position[k + 1] - poses.position[k - 1]).norm() / (2 * kScoreStep);
    differentiate(&features.speed[at], present, false, &features.acceleration[at]);
    differentiate(&poses.heading[at], present, true, &features.yaw_rate[at]);
    differentiate(&features.yaw_rate[at], present, false, &features.yaw_acceleration[at]);
  }
  PairFeatures pairs(poses, bodies, features);
  for (std::size_t step = 0; step < Poses::kSteps; ++step) pairs.look_at(step);
  return features;
}

bool collides(const MotionFeatures& features, std::size_t row) {
  const auto from = features.nearest.begin() + static_cast<std::ptrdiff_t>(row * Poses::kSteps);
  return std::any_of(from, from + static_cast<std::ptrdiff_t>(Poses::kSteps),
                     [](double gap) { return gap < 0.0; });
}

}  // namespace sumogamma
