#include "ego/ego_action.h"

#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"
#include "model/tracking.h"

namespace sumogamma {

namespace {

/// Where the trajectory is at a time, straight between its points; on at its last pace behind them.
Vec2 trajectory_at(const std::vector<TrajectoryPoint>& points, double time) {
  const auto after = std::find_if(points.begin() + 1, points.end(),
                                  [&](const auto& point) { return time <= point.time; });
  const TrajectoryPoint& to = after == points.end() ? points.back() : *after;
  const TrajectoryPoint& from = *(after == points.end() ? points.end() - 2 : after - 1);
  const double span = std::max(to.time - from.time, 1e-6);
  return from.position + (to.position - from.position) * ((time - from.time) / span);
}

/// The velocity whose part along the heading is `speed`, in a direction.
Vec2 with_speed_ahead(const Vec2& direction, const Vec2& forward, double speed) {
  constexpr double kLeast = 0.3;  // cosine: nothing on wheels turns sharper
  const double length = direction.norm();
  if (length < 1e-9) return speed * forward;
  const Vec2 unit = direction / length;
  return unit * (speed / std::max(unit.dot(forward), kLeast));
}

/// The velocity that the steering law of advance_body turns into a front wheel angle.
Vec2 with_steering(const AgentType& type, const Vec2& forward, double speed, double steering) {
  const double most = std::min(type.max_steering, 1.4);
  const double lock = std::tan(std::clamp(steering, -most, most));
  const double reach = steering_lead(type, speed) + type.rear_axle_to_center;
  return from_body(Vec2(speed, speed * lock * reach / type.wheelbase), forward);
}

}  // namespace

EgoAction full_braking(const AgentType& type) {
  EgoAction action;
  action.acceleration = -type.max_deceleration;
  return action;
}

Vec2 velocity_of(const EgoAction& action, const Model& model, const Scene& scene, std::size_t row,
                 const ActionPace& pace) {
  constexpr double kPursuit = 0.25;  // [s]
  const AgentType& type = type_of(model.types, scene.type[row]);
  const Vec2 forward = direction_of(scene.heading[row]);
  if (action.trajectory.size() > 1) {
    const Vec2 there = trajectory_at(action.trajectory, pace.since + kPursuit);
    const Vec2 wish = (there - scene.position[row]) / kPursuit;
    const double speed = std::clamp(wish.dot(forward), 0.0, pace.max_speed);
    return with_speed_ahead(wish, forward, speed);
  }
  const double speed = std::clamp(scene.speed[row] + action.acceleration * pace.dt, 0.0,
                                  std::max(pace.max_speed, 0.0));
  if (action.steering) return with_steering(type, forward, speed, *action.steering);
  const RoadContext& context = scene.context[row];
  const Vec2 towards = context.active ? Vec2(context.sub_goal - scene.position[row]) : forward;
  return with_speed_ahead(towards, forward, speed);
}

}  // namespace sumogamma
