#include "traffic/longitudinal/allowed_speed.h"

#include <algorithm>
#include <cmath>

#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

namespace {

/// The throttle goes down at ease where the vehicle drives: a cap on the jerk that following and
/// avoidance leave, however they take turns. Brakes and the start are not eased.
double eased(const TrafficView& view, const Course& course, double acceleration, double dt) {
  if (course.speed < view.parameters.flow_speed) return acceleration;
  const double now =
      view.scene.acceleration[course.row].dot(direction_of(view.scene.heading[course.row]));
  return std::min(acceleration, std::max(now, 0.0) + view.parameters.throttle_jerk * dt);
}

/// Who has to be aside within `way` aims at a sub-goal no further ahead.
void aim_sooner(const TrafficView& view, const Course& course, double way, RoadContext& context) {
  const Vec2 position = view.scene.position[course.row];
  const Vec2 goal = to_body(context.sub_goal - position, context.tangent);
  const double ahead =
      std::min(goal.x(), std::max({0.6 * way, view.parameters.steepest_aim * std::abs(goal.y()),
                                   view.parameters.closed_up_gap}));
  context.sub_goal = position + from_body(Vec2(ahead, goal.y()), context.tangent);
}

/// The acceleration that binds [m/s^2], noted with its reason.
double binding_acceleration(const Driver& driver, const StopPoints& found, RoadContext& context) {
  StopPoint free_road;
  double binding = acceleration_behind(driver, free_road);
  for (const StopPoint& point : found.points) {
    const double acceleration = acceleration_behind(driver, point);
    if (acceleration >= binding) continue;
    binding = acceleration;
    context.reason = point.reason;
    context.foe = point.foe;
  }
  return binding;
}

}  // namespace

double foreseen_limit(const TrafficParameters& parameters, const Path& path, double along,
                      double speed, double dt) {
  const double here = path.profile_at(along);
  const double way =
      std::max(std::max(parameters.reaction_time, dt) * speed, parameters.closed_up_gap);
  const double there = path.profile_at(along + way);
  if (there >= speed) return std::max(here, speed);
  const double braking = (speed * speed - there * there) / (2.0 * way);
  return std::max(speed - braking * dt, there);
}

void set_allowed_speed(const TrafficView& view, const Course& course, double dt, StopPoints& found,
                       RoadContext& context) {
  const AgentType& type = course.type;
  const Driver driver = driver_of(view, course, context.speed_limit);
  find_stop_points(driver, found);
  context.to_halt = found.to_halt;
  context.at_red = found.at_red;
  if (std::isfinite(found.ahead.turning_way))
    aim_sooner(view, course, found.ahead.turning_way, context);
  const double binding = binding_acceleration(driver, found, context);
  context.allowed_speed = std::max(0.0, course.speed + eased(view, course, binding, dt) * dt);
  if (view.traffic.gives_way_left[course.row] > 0.0) {
    context.allowed_speed = 0.0;
    context.reason = LimitReason::GivesWay;
    context.foe = -1;
    return;
  }
  // who may start has room to find out where to: how fast it gets there is the body's business
  if (binding > 0.5 * type.max_acceleration)
    context.allowed_speed = std::max(context.allowed_speed, view.parameters.halting_speed);
  const double passing =
      std::max(found.ahead.passing_speed, course.speed - type.comfortable_deceleration * dt);
  if (passing < context.allowed_speed) {
    context.allowed_speed = passing;
    context.reason = LimitReason::Leader;
    context.foe = found.ahead.passed;
  }
}

}  // namespace sumogamma
