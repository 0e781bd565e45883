#include "model/preferred_velocity.h"

#include <algorithm>

#include "base/random.h"

namespace sumogamma {

namespace {
Vec2 towards(const Vec2& from, const Vec2& to, double speed) {
  const Vec2 delta = to - from;
  const double distance = delta.norm();
  return distance > 1e-9 ? Vec2(delta * (speed / distance)) : Vec2(Vec2::Zero());
}

/// A wheeled body can't head for what lies beside or behind it: it asks for its tightest slow turn
/// towards it instead.
Vec2 within_turning(const Vec2& preferred, double heading) {
  constexpr double kWidest = 0.9;     // [rad]
  constexpr double kTurnSpeed = 2.0;  // [m/s]
  const Vec2 forward = direction_of(heading);
  const double angle = std::atan2(cross(forward, preferred), forward.dot(preferred));
  if (std::abs(angle) <= kWidest) return preferred;
  return std::min(preferred.norm(), kTurnSpeed) *
         direction_of(heading + std::copysign(kWidest, angle));
}

/// Somebody on foot who stands although nothing on the road holds him tries another way round every
/// second: a turn of up to a right angle and more, drawn from id and time alone.
Vec2 around(const Vec2& preferred, const Scene& scene, std::size_t row) {
  constexpr double kPatience = 2.0;  // [s]
  if (scene.held[row].blocked < kPatience || scene.context[row].reason != LimitReason::None)
    return preferred;
  const double turn = random_uniform(0, scene.id[row].value, static_cast<std::uint64_t>(scene.time),
                                     Draw::Intention, -2.2, 2.2);
  return 0.6 * from_body(preferred, direction_of(turn));
}
}  // namespace

double share_ahead(const Vec2& velocity, const Vec2& forward) {
  constexpr double kLeast = 0.8;
  const double speed = velocity.norm();
  return speed > 1e-9 ? std::clamp(velocity.dot(forward) / speed, kLeast, 1.0) : 1.0;
}

Vec2 preferred_velocity(const Model& model, const Scene& scene, std::size_t row,
                        const Intention& intention) {
  const AgentType& type = type_of(model.types, scene.type[row]);
  switch (intention.kind) {
    case IntentionKind::Goal: {
      // slower within the last second, so that it comes to rest there
      const double distance = (intention.goal - scene.position[row]).norm();
      return towards(scene.position[row], intention.goal,
                     std::min(scene.preferred_speed[row], distance));
    }
    case IntentionKind::Path: {
      const RoadContext& context = scene.context[row];
      if (!context.active)
        return towards(scene.position[row], intention.goal, scene.preferred_speed[row]);
      double speed = std::min(context.speed_limit, scene.preferred_speed[row]);
      // who waits on foot stands still, sideways too: the kerb need not lie across the path
      if (type.kinematics == Kinematics::Holonomic) speed = std::min(speed, context.allowed_speed);
      const Vec2 preferred = towards(scene.position[row], context.sub_goal, speed);
      if (type.kinematics == Kinematics::Holonomic) return around(preferred, scene, row);
      // a wheeled body keeps its speed along its heading while it turns
      const double ahead = share_ahead(preferred, direction_of(scene.heading[row]));
      return within_turning(preferred / ahead, scene.heading[row]);
    }
    case IntentionKind::KeepVelocity:
      return scene.velocity[row];
    case IntentionKind::KeepAcceleration: {
      const Vec2 later = scene.velocity[row] + 0.5 * type.horizon * scene.acceleration[row];
      const double speed = later.norm();
      return speed > type.max_speed ? Vec2(later * (type.max_speed / speed)) : later;
    }
    case IntentionKind::Velocity:
      return intention.goal;
    case IntentionKind::ConstantTurnRate:
    case IntentionKind::Stop:
      break;
  }
  return Vec2::Zero();
}

double side_to_pass(const ModelOptions& options, const Scene& scene, std::size_t row) {
  constexpr double kAside = 0.1;  // [m]
  const double aside = scene.context[row].aside;
  if (std::abs(aside) > kAside) return std::copysign(1.0, aside);
  return options.keep_left ? 1.0 : -1.0;
}

}  // namespace sumogamma
