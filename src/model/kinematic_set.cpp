#include "model/kinematic_set.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "model/model.h"
#include "model/tracking.h"

namespace sumogamma {

namespace {

// grid of target speeds and angles of Eq. 1
constexpr double kSpeedStep = 0.1;  // [m/s]
constexpr int kAnglesASide = 6;
constexpr int kTrackingSteps = 40;  // over the horizon
// a steering rate above this reaches any angle at once, so that the present angle doesn't matter
// [rad/s]
constexpr double kInstantSteering = 12.0;
// deviations beyond the slip of the centre must be reached within this time at walking speed
constexpr double kShuffle = 0.05;      // [m/s]
constexpr double kTurnTime = 0.3;      // [s]
constexpr double kWalkingSpeed = 1.0;  // [m/s]
// planes that lie this far beyond the speed limit can't bind
constexpr double kSpeedTolerance = 1e-3;  // [m/s]

/// Directions that the footprint's centre can take at all: at once through the slip angle that full
/// lock gives it, or through the heading's turn within kTurnTime at walking speed. Beyond them a
/// body would slide sideways.
double largest_deviation(const AgentType& type) {
  const double lock = std::tan(std::min(type.max_steering, radians(80)));
  const double slip = std::atan(type.rear_axle_to_center * lock / type.wheelbase);
  const double turn = kTurnTime * kWalkingSpeed * lock / type.wheelbase;
  return std::max(slip, std::min(turn, type.max_steering));
}

/// Largest trackable speed along a deviation angle (Eq. 1); 0 where there is none.
double largest_speed(const AgentType& type, double speed, double steering, double angle) {
  const double up = std::sqrt(2.0 * type.max_acceleration * type.tracking_error);
  const double down = std::sqrt(2.0 * type.max_deceleration * type.tracking_error);
  const double high = std::min(type.max_speed, speed + up + 2.0 * kSpeedStep);
  const double low = std::max(0.5 * kSpeedStep, speed - down - 2.0 * kSpeedStep);
  double target = high;
  while (target >= low) {
    const Vec2 velocity = target * direction_of(angle);
    if (tracking_error(type, speed, steering, velocity, type.horizon) <= type.tracking_error)
      return target;
    target -= kSpeedStep;
  }
  return 0;
}

/// Support of the hull of the fan and the null velocity along each normal (Eq. 2).
void hull_supports(const std::vector<Vec2>& fan, const std::vector<Vec2>& normals,
                   KinematicSet& set) {
  for (std::size_t k = 0; k < normals.size(); ++k) {
    set.support[k] = 0;
    for (const Vec2& point : fan) set.support[k] = std::max(set.support[k], normals[k].dot(point));
  }
}

KinematicSet wheeled_set(const AgentType& type, double speed, double steering,
                         const std::vector<Vec2>& normals) {
  const double step = largest_deviation(type) / kAnglesASide;
  std::vector<Vec2> fan;
  double left = 0, right = 0;
  for (int k = -kAnglesASide; k <= kAnglesASide; ++k) {
    const double angle = k * step;
    const double most = largest_speed(type, speed, steering, angle);
    if (most <= 0) continue;
    left = std::max(left, angle);
    right = std::max(right, -angle);
    fan.push_back(most * direction_of(angle));
  }
  // a body that can track nothing else (a limit changed under it) may still roll straight on
  if (fan.empty()) fan.push_back({std::max(speed, kSpeedStep), 0.0});
  KinematicSet set;
  hull_supports(fan, normals, set);
  // the sides are a grid step apart: half a step more is as trackable as the grid can tell
  set.left = direction_of(std::max(left, 0.5 * step));
  set.right = direction_of(-std::max(right, 0.5 * step));
  return set;
}

KinematicSet holonomic_set(const AgentType& type, double speed, const std::vector<Vec2>& normals) {
  // finer ahead, where a fast body has all it can track
  constexpr double kAngles[] = {0, 4, 8, 15, 25, 45, 70, 90, 115, 135, 160, 180};
  std::vector<Vec2> fan;
  for (const double angle : kAngles) {
    const double most = largest_speed(type, speed, 0, radians(angle));
    fan.push_back(most * direction_of(radians(angle)));
    fan.push_back(most * direction_of(radians(-angle)));
  }
  KinematicSet set;
  hull_supports(fan, normals, set);
  // a shuffle in any direction, so that the set never shrinks to a line
  for (std::size_t k = 0; k < normals.size(); ++k)
    set.support[k] = std::max(set.support[k], kShuffle);
  return set;
}

std::vector<double> speed_nodes(const AgentType& type) {
  std::vector<double> nodes = {0, 0.5};
  while (nodes.back() < type.max_speed)
    nodes.push_back(std::min(type.max_speed, nodes.back() * 1.3 + 0.5));
  return nodes;
}

std::vector<double> steering_nodes(const AgentType& type) {
  if (type.kinematics == Kinematics::Holonomic || type.max_steering_rate >= kInstantSteering)
    return {0};
  std::vector<double> nodes;
  for (int k = -2; k <= 2; ++k) nodes.push_back(0.5 * k * type.max_steering);
  return nodes;
}

std::vector<Vec2> face_normals(const AgentType& type) {
  std::vector<Vec2> normals;
  if (type.kinematics == Kinematics::Holonomic) {
    for (int k = 0; k < 8; ++k) normals.push_back(direction_of(k * (kPi / 4)));
  } else {
    for (double angle : {0.0, radians(30), radians(-30)}) normals.push_back(direction_of(angle));
  }
  return normals;
}

/// Lower node and weight of the upper one for a value within sorted nodes.
std::pair<std::size_t, double> locate(const std::vector<double>& nodes, double value) {
  if (nodes.size() < 2 || !(value > nodes.front())) return {0, 0.0};
  if (value >= nodes.back()) return {nodes.size() - 2, 1.0};
  std::size_t lower = 0;
  while (nodes[lower + 1] < value) ++lower;
  return {lower, (value - nodes[lower]) / (nodes[lower + 1] - nodes[lower])};
}

KinematicSet blend(const KinematicSet& a, const KinematicSet& b, double weight, std::size_t faces) {
  if (weight <= 0) return a;
  KinematicSet set;
  for (std::size_t k = 0; k < faces; ++k)
    set.support[k] = a.support[k] + weight * (b.support[k] - a.support[k]);
  set.left = a.left + weight * (b.left - a.left);
  set.right = a.right + weight * (b.right - a.right);
  return set;
}

}  // namespace

double tracking_error(const AgentType& type, double speed, double steering, const Vec2& velocity,
                      double horizon) {
  const double dt = horizon / kTrackingSteps;
  BodyState body;
  body.speed = speed;
  body.velocity = {speed, 0.0};
  body.steering = steering;
  double worst = 0;
  for (int step = 1; step <= kTrackingSteps && worst <= type.tracking_error; ++step) {
    body = advance_body(type, body, velocity, dt);
    worst = std::max(worst, (velocity * (step * dt) - body.position).norm());
  }
  return worst;
}

KinematicSet KinematicTable::at(double speed, double steering) const {
  const auto [s, along_speed] = locate(speeds_, speed);
  const std::size_t above = s + 1 < speeds_.size() ? s + 1 : s;
  const std::size_t faces = normals_.size();
  KinematicSet set;
  if (steerings_.size() < 2) {
    set = blend(node(s, 0), node(above, 0), along_speed, faces);
  } else {
    const auto [d, along_steering] = locate(steerings_, steering);
    const KinematicSet low = blend(node(s, d), node(above, d), along_speed, faces);
    set = along_steering <= 0
              ? low
              : blend(low, blend(node(s, d + 1), node(above, d + 1), along_speed, faces),
                      along_steering, faces);
  }
  if (has_sides_) {
    set.left.normalize();
    set.right.normalize();
  }
  return set;
}

std::vector<KinematicTable> build_kinematic_tables(const AgentTypeTable& types, Workers& workers) {
  std::vector<KinematicTable> tables(types.size());
  struct Cell {
    std::size_t type, speed, steering;
  };
  std::vector<Cell> cells;
  for (std::size_t t = 0; t < types.size(); ++t) {
    KinematicTable& table = tables[t];
    table.speeds_ = speed_nodes(types[t]);
    table.steerings_ = steering_nodes(types[t]);
    table.normals_ = face_normals(types[t]);
    table.has_sides_ = types[t].kinematics != Kinematics::Holonomic;
    table.nodes_.resize(table.speeds_.size() * table.steerings_.size());
    for (std::size_t s = 0; s < table.speeds_.size(); ++s)
      for (std::size_t d = 0; d < table.steerings_.size(); ++d) cells.push_back({t, s, d});
  }
  workers.for_each_range(cells.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto [t, s, d] = cells[k];
      KinematicTable& table = tables[t];
      table.nodes_[s * table.steerings_.size() + d] =
          table.has_sides_
              ? wheeled_set(types[t], table.speeds_[s], table.steerings_[d], table.normals_)
              : holonomic_set(types[t], table.speeds_[s], table.normals_);
    }
  });
  for (std::size_t t = 0; t < tables.size(); ++t) {
    KinematicTable& table = tables[t];
    const std::size_t faces = table.normals_.size();
    table.is_everything_ =
        !table.has_sides_ &&
        std::all_of(table.nodes_.begin(), table.nodes_.end(), [&](const KinematicSet& set) {
          return std::all_of(
              set.support.begin(), set.support.begin() + static_cast<std::ptrdiff_t>(faces),
              [&](double support) { return support >= types[t].max_speed - kSpeedTolerance; });
        });
  }
  return tables;
}

void append_kinematic_constraints(const Model& model, const Scene& scene, std::size_t row,
                                  const Vec2& forward, ConstraintSet& constraints) {
  const KinematicTable& table = model.kinematics[static_cast<std::size_t>(scene.type[row])];
  if (!model.options.use_kinematics || table.is_everything()) return;
  const AgentType& type = type_of(model.types, scene.type[row]);
  const KinematicSet set = table.at(scene.speed[row], scene.steering[row]);
  const ConstraintSource source{ConstraintKind::Kinematic, -1};
  Vec2 axis = forward;
  if (table.has_sides()) {
    constraints.append({Vec2::Zero(), from_body({set.left.y(), -set.left.x()}, axis)}, source);
    constraints.append({Vec2::Zero(), from_body({-set.right.y(), set.right.x()}, axis)}, source);
  } else if (scene.speed[row] > 1e-6) {
    axis = scene.velocity[row].normalized();
  }
  for (std::size_t k = 0; k < table.normals().size(); ++k) {
    if (set.support[k] >= type.max_speed - kSpeedTolerance) continue;
    const Vec2 outward = from_body(table.normals()[k], axis);
    constraints.append({set.support[k] * outward, -outward}, source);
  }
}

}  // namespace sumogamma
