#include "model/tracking.h"

#include <algorithm>

#include "base/units.h"
#include "geometry/rotation.h"

namespace sumogamma {

namespace {

// the heading comes round to the asked direction within about this time at speed [s]
constexpr double kSteeringTime = 0.25;
// below this speed somebody on foot shuffles: sideways and back as well, without turning [m/s]
constexpr double kFacingSpeed = 0.3;
// nothing on wheels locks farther [rad]
const double kMostSteering = radians(80);

BodyState advance_holonomic(const AgentType& type, const BodyState& body, const Vec2& velocity,
                            double dt) {
  BodyState next = body;
  const double asked_speed = velocity.norm();
  const Vec2 asked =
      asked_speed > type.max_speed ? Vec2(velocity * (type.max_speed / asked_speed)) : velocity;
  // turning and slowing down take what braking takes, getting faster takes more time
  const Vec2 change = asked - body.velocity;
  const double length = change.norm(), most = type.max_deceleration * dt;
  next.velocity = length > most ? Vec2(body.velocity + change * (most / length)) : asked;
  const double fastest = body.velocity.norm() + type.max_acceleration * dt,
               speed = next.velocity.norm();
  if (speed > fastest) next.velocity *= fastest / speed;
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

/// Tangent of the front wheel angle that points the centre's velocity along `lateral / forward`
/// (body axes), softened at speed. At the limit, full lock: beyond a right angle there is nothing
/// better.
double asked_lock(const AgentType& type, double speed, double forward, double lateral,
                  double most) {
  if (forward <= 0) return lateral == 0 ? 0.0 : std::copysign(most, lateral);
  // the centre moves along v where the rear axle's curvature is tan(angle) / (rear axle to centre)
  const double reach =
      std::max({type.rear_axle_to_center, kSteeringTime * speed, 0.1 * type.wheelbase});
  return std::clamp(type.wheelbase * lateral / (forward * reach), -most, most);
}

/// The wheels turn towards the asked angle within angle, rate and grip; returns the tangent of the
/// new angle.
double turn_wheels(const AgentType& type, const Vec2& asked, double dt, BodyState& next) {
  double most = tangent(std::min(type.max_steering, kMostSteering));
  const double grip = type.max_lateral_acceleration * type.wheelbase;
  if (next.speed * next.speed * most > grip) most = grip / (next.speed * next.speed);
  // a body that is told to stand keeps its wheels as they are
  double lock = asked.squaredNorm() > 1e-12
                    ? asked_lock(type, next.speed, asked.x(), asked.y(), most)
                    : std::clamp(tangent(next.steering), -most, most);
  const double wanted = std::atan(lock);
  const double most_change = type.max_steering_rate * dt;
  const double steering =
      std::clamp(wanted, next.steering - most_change, next.steering + most_change);
  if (steering != wanted) lock = tangent(steering);
  next.steering = steering;
  return lock;
}

BodyState advance_single_track(const AgentType& type, const BodyState& body, const Vec2& velocity,
                               double dt) {
  BodyState next = body;
  const Vec2 forward = rotation(body.heading);
  const Vec2 asked = to_body(velocity, forward);

  const double target = std::clamp(asked.x(), 0.0, type.max_speed);
  next.speed = std::max(0.0, std::clamp(target, body.speed - type.max_deceleration * dt,
                                        body.speed + type.max_acceleration * dt));
  const double lock = turn_wheels(type, asked, dt, next);

  // exact arc of the rear axle, and the centre's swing about it
  const double distance = next.speed * dt;
  const double turn = distance * lock / type.wheelbase;
  const double half = 0.5 * turn;
  const Vec2 half_turn = rotation(half);
  const double chord = distance * (std::abs(half) > 1e-6 ? half_turn.y() / half : 1.0);
  const Vec2 whole_turn(half_turn.x() * half_turn.x() - half_turn.y() * half_turn.y(),
                        2.0 * half_turn.x() * half_turn.y());
  const Vec2 displacement =
      from_body(chord * half_turn + type.rear_axle_to_center * (whole_turn - Vec2(1, 0)), forward);
  next.heading = body.heading + turn;
  if (std::abs(next.heading) > kPi) next.heading = wrap_angle(next.heading);
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
