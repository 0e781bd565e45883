#include "traffic/longitudinal/car_following.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sumogamma {

double kept_headway(const AgentType& type, double speed) {
  if (type.steady_headway) return type.headway;
  return type.headway *
         std::min(type.queue_headway +
                      (1.0 - type.queue_headway) * std::max(speed, 0.0) / type.full_headway_speed,
                  1.0);
}

double headway_memory(const TrafficParameters& parameters, double since_standing) {
  const double forgotten =
      (since_standing - parameters.desperate) / (parameters.hopeless - parameters.desperate);
  return 1.0 - (1.0 - parameters.flowing_headway) * std::clamp(forgotten, 0.0, 1.0);
}

double following_acceleration(const AgentType& type, double speed, double free_speed, double gap,
                              double leader_speed, double headway_factor) {
  const double a = type.max_acceleration, b = type.comfortable_deceleration;
  const double ratio = speed / std::max(free_speed, 0.1);
  const double fourth = ratio * ratio * ratio * ratio;
  double acceleration = a * (1.0 - fourth * fourth);
  // slowing for a lower limit is done at ease: that power would brake like for a wall
  acceleration = std::max(acceleration, -b);
  if (std::isfinite(gap)) {
    if (gap <= 0.05) return -type.max_deceleration;
    const double approach = speed * (speed - leader_speed) / (2.0 * std::sqrt(a * b));
    const double wanted =
        type.min_gap + std::max(0.0, speed * headway_factor * kept_headway(type, speed) + approach);
    const double pressure = wanted / gap;
    acceleration = std::min(acceleration, a * (1.0 - pressure * pressure));
  }
  return std::clamp(acceleration, -type.max_deceleration, a);
}

double braking_behind(double speed, const Followed& followed) {
  const double gap = std::max(followed.gap, 0.05), their = followed.speed;
  const double theirs = std::max(-followed.acceleration, 0.0);
  const double closing = std::max(speed - their, 0.0);
  // does the other stand before the two are equally fast?
  if (theirs > 0.0 && their * (speed - their) <= 2.0 * gap * theirs)
    return speed * speed * theirs / (their * their + 2.0 * gap * theirs);
  return theirs + closing * closing / (2.0 * gap);
}

double behind_acceleration(const AgentType& type, double speed, double free_speed,
                           const Followed& followed, double headway_factor) {
  const double plain =
      following_acceleration(type, speed, free_speed, followed.gap, followed.speed, headway_factor);
  if (followed.gap <= 0.05 || !std::isfinite(followed.gap)) return plain;
  const double steady = -braking_behind(speed, followed), b = type.comfortable_deceleration;
  if (plain >= steady) return plain;
  const double cool = steady + b * std::tanh((plain - steady) / b);
  return std::clamp(0.01 * plain + 0.99 * cool, -type.max_deceleration, type.max_acceleration);
}

double deceleration_to_stop(double speed, double distance) {
  if (speed <= 0.0) return 0.0;
  return distance > 0.0 ? speed * speed / (2.0 * distance)
                        : std::numeric_limits<double>::infinity();
}

double time_to_cover(double distance, double speed, double top_speed, double acceleration) {
  if (distance <= 0.0) return 0.0;
  top_speed = std::max({top_speed, speed, 0.1});
  const double until_top = (top_speed * top_speed - speed * speed) / (2.0 * acceleration);
  if (distance <= until_top)
    return (std::sqrt(speed * speed + 2.0 * acceleration * distance) - speed) / acceleration;
  return (top_speed - speed) / acceleration + (distance - until_top) / top_speed;
}

}  // namespace sumogamma
