#include "model/tracking.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// A front wheel angle [rad] with its tangent.
struct Steering {
  double angle, lock;
};

/// The angle of a tangent, or what the type's limits of angle and grip leave of it.
Steering within_limits(const AgentType& type, double speed, double lock) {
  constexpr double kGrip =
      1.6;  // of what is comfortable: paths are planned for the comfortable mean
  const double grip = kGrip * type.max_lateral_acceleration * type.wheelbase;
  const double square = speed * speed;
  if (square * std::abs(lock) > grip) lock = std::copysign(grip / square, lock);
  const double angle = std::atan(lock), most = std::min(type.max_steering, kMostSteering);
  if (std::abs(angle) <= most) return {angle, lock};
  return {std::copysign(most, lock), std::copysign(tangent(most), lock)};
}

/// The centre moves along v where the rear axle's curvature is tan(angle of v) over this [m].
double steering_reach(const AgentType& type, double speed) {
  return std::max({type.rear_axle_to_center, kSteeringTime * speed, 0.1 * type.wheelbase});
}

/// Tangent of the angle that points the centre's velocity along `asked` (body axes), softened at
/// speed. Beyond a right angle there is nothing better than full lock.
double asked_lock(const AgentType& type, double speed, const Vec2& asked) {
  if (asked.x() <= 0)
    return asked.y() == 0 ? 0.0 : std::copysign(std::numeric_limits<double>::infinity(), asked.y());
  return type.wheelbase * asked.y() / (asked.x() * steering_reach(type, speed));
}

/// The wheels turn towards the asked angle within angle, rate and grip.
Steering turn_wheels(const AgentType& type, const BodyState& body, double speed, const Vec2& asked,
                     double dt) {
  // a body that is told to stand keeps its wheels as they are
  const double lock =
      asked.squaredNorm() > 1e-12 ? asked_lock(type, speed, asked) : tangent(body.steering);
  const Steering wanted = within_limits(type, speed, lock);
  const double most_change = type.max_steering_rate * dt;
  const double angle =
      std::clamp(wanted.angle, body.steering - most_change, body.steering + most_change);
  return angle == wanted.angle ? wanted : Steering{angle, tangent(angle)};
}

/// Rolls by `distance` [m] (negative: back) on the exact arc of the rear axle with these wheels.
Advanced roll(const AgentType& type, const BodyState& body, const Vec2& forward,
              const Steering& steering, double distance, double dt) {
  Advanced next{body};
  // the arc, and the centre's swing about the rear axle
  const double turn = distance * steering.lock / type.wheelbase;
  const double half = 0.5 * turn;
  const Vec2 half_turn = rotation(half);
  const double chord = distance * (std::abs(half) > 1e-6 ? half_turn.y() / half : 1.0);
  const Vec2 whole_turn(half_turn.x() * half_turn.x() - half_turn.y() * half_turn.y(),
                        2.0 * half_turn.x() * half_turn.y());
  const Vec2 displacement =
      from_body(chord * half_turn + type.rear_axle_to_center * (whole_turn - Vec2(1, 0)), forward);
  next.body.steering = steering.angle;
  next.body.heading = body.heading + turn;
  if (std::abs(next.body.heading) > kPi) next.body.heading = wrap_angle(next.body.heading);
  next.body.position = body.position + displacement;
  next.body.velocity = displacement / dt;
  next.forward = from_body(whole_turn, forward);
  next.lock = steering.lock;
  return next;
}

Advanced advance_single_track(const AgentType& type, const BodyState& body, const Vec2& forward,
                              const Vec2& velocity, double dt) {
  const Vec2 asked = to_body(velocity, forward);
  const double target = std::clamp(asked.x(), 0.0, type.max_speed);
  const double speed = std::max(0.0, std::clamp(target, body.speed - type.max_deceleration * dt,
                                                body.speed + type.max_acceleration * dt));
  const Steering steering = turn_wheels(type, body, speed, asked, dt);
  Advanced next = roll(type, body, forward, steering, speed * dt, dt);
  next.body.speed = speed;
  return next;
}

}  // namespace

Advanced advance_body(const AgentType& type, const BodyState& body, const Vec2& forward,
                      const Vec2& velocity, double dt) {
  const Vec2 asked = velocity.allFinite() ? velocity : Vec2(Vec2::Zero());
  if (type.kinematics != Kinematics::Holonomic)
    return advance_single_track(type, body, forward, asked, dt);
  Advanced next{advance_holonomic(type, body, asked, dt)};
  next.forward = next.body.heading == body.heading ? forward : rotation(next.body.heading);
  return next;
}

BodyState advance_body(const AgentType& type, const BodyState& body, const Vec2& velocity,
                       double dt) {
  return advance_body(type, body, rotation(body.heading), velocity, dt).body;
}

double steering_lead(const AgentType& type, double speed) {
  return steering_reach(type, speed) - type.rear_axle_to_center;
}

BodyState roll_back(const AgentType& type, const BodyState& body, double lock, double speed,
                    double dt) {
  const Steering wanted = within_limits(type, speed, lock);
  const double most_change = type.max_steering_rate * dt;
  const double angle =
      std::clamp(wanted.angle, body.steering - most_change, body.steering + most_change);
  BodyState next =
      roll(type, body, rotation(body.heading), {angle, tangent(angle)}, -speed * dt, dt).body;
  next.speed = 0.0;
  return next;
}

BodyState body_of(const Scene& scene, std::size_t row) {
  return {scene.position[row], scene.heading[row], scene.velocity[row], scene.speed[row],
          scene.steering[row]};
}

void place_body(const BodyState& body, Scene& scene, std::size_t row) {
  scene.position[row] = body.position;
  scene.heading[row] = body.heading;
  scene.velocity[row] = body.velocity;
  scene.speed[row] = body.speed;
  scene.steering[row] = body.steering;
}

BodyState track_velocity(const Model& model, const Scene& scene, std::size_t row,
                         const Vec2& velocity, double dt) {
  return advance_body(type_of(model.types, scene.type[row]), body_of(scene, row), velocity, dt);
}

}  // namespace sumogamma
