#include "model/tracking.h"

#include <algorithm>

#include "base/units.h"

namespace sumogamma {

namespace {

// the heading comes round to the asked direction within about this time at speed [s]
constexpr double kSteeringTime = 0.25;
// below this speed a pedestrian keeps facing where it faced [m/s]
constexpr double kFacingSpeed = 0.05;

BodyState advance_holonomic(const AgentType& type, const BodyState& body, const Vec2& velocity,
                            double dt) {
  BodyState next = body;
  const double asked_speed = velocity.norm();
  const Vec2 asked =
      asked_speed > type.max_speed ? Vec2(velocity * (type.max_speed / asked_speed)) : velocity;
  const Vec2 change = asked - body.velocity;
  const bool speeding_up = asked.squaredNorm() > body.velocity.squaredNorm();
  const double most = (speeding_up ? type.max_acceleration : type.max_deceleration) * dt;
  const double length = change.norm();
  next.velocity = length > most ? Vec2(body.velocity + change * (most / length)) : asked;
  next.position = body.position + next.velocity * dt;
  next.speed = next.velocity.norm();
  next.steering = 0;
  if (next.speed > kFacingSpeed) {
    const double turn = wrap_angle(heading_of(next.velocity) - body.heading);
    const double most_turn = type.max_steering_rate * dt;
    next.heading = wrap_angle(body.heading + std::clamp(turn, -most_turn, most_turn));
  }
  return next;
}

/// Front wheel angle that points the centre's velocity along `lateral / forward` (body axes),
/// softened at speed.
double asked_steering(const AgentType& type, double speed, double forward, double lateral) {
  if (forward == 0 && lateral == 0) return 0;
  // beyond a right angle there is nothing better than full lock
  if (forward <= 0) return lateral >= 0 ? type.max_steering : -type.max_steering;
  // the centre moves along v where its curvature is tan(angle) / (rear axle to centre)
  const double reach =
      std::max({type.rear_axle_to_center, kSteeringTime * speed, 0.1 * type.wheelbase});
  return std::atan(type.wheelbase * (lateral / forward) / reach);
}

BodyState advance_single_track(const AgentType& type, const BodyState& body, const Vec2& velocity,
                               double dt) {
  BodyState next = body;
  const Vec2 forward = direction_of(body.heading);
  const Vec2 asked = to_body(velocity, forward);

  const double target = std::clamp(asked.x(), 0.0, type.max_speed);
  next.speed = std::clamp(target, body.speed - type.max_deceleration * dt,
                          body.speed + type.max_acceleration * dt);
  next.speed = std::max(next.speed, 0.0);

  // a body that is told to stand keeps its wheels as they are
  double steering = body.steering;
  if (asked.squaredNorm() > 1e-12)
    steering = asked_steering(type, next.speed, asked.x(), asked.y());
  double most = type.max_steering;
  const double grip = type.max_lateral_acceleration * type.wheelbase;
  if (next.speed * next.speed * std::tan(most) > grip)
    most = std::atan(grip / (next.speed * next.speed));
  const double most_change = type.max_steering_rate * dt;
  steering = std::clamp(steering, -most, most);
  steering = std::clamp(steering, body.steering - most_change, body.steering + most_change);
  next.steering = std::clamp(steering, -type.max_steering, type.max_steering);

  // exact arc of the rear axle
  const double distance = next.speed * dt;
  const double turn = distance * std::tan(next.steering) / type.wheelbase;
  next.heading = wrap_angle(body.heading + turn);
  const double half = 0.5 * turn;
  const double chord = distance * (std::abs(half) > 1e-6 ? std::sin(half) / half : 1.0);
  const Vec2 next_forward = direction_of(next.heading);
  const Vec2 displacement = chord * direction_of(body.heading + half) +
                            type.rear_axle_to_center * (next_forward - forward);
  next.position = body.position + displacement;
  next.velocity = displacement / dt;
  return next;
}

}  // namespace

BodyState advance_body(const AgentType& type, const BodyState& body, const Vec2& velocity,
                       double dt) {
  const Vec2 asked = velocity.allFinite() ? velocity : Vec2(Vec2::Zero());
  return type.kinematics == Kinematics::Holonomic ? advance_holonomic(type, body, asked, dt)
                                                  : advance_single_track(type, body, asked, dt);
}

BodyState body_of(const Scene& scene, std::size_t row) {
  return {scene.position[row], scene.heading[row], scene.velocity[row], scene.speed[row],
          scene.steering[row]};
}

BodyState track_velocity(const Model& model, const Scene& scene, std::size_t row,
                         const Vec2& velocity, double dt) {
  return advance_body(type_of(model.types, scene.type[row]), body_of(scene, row), velocity, dt);
}

}  // namespace sumogamma
