#include "planning/pursuit.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

double pursuit_steering(const WheeledShape& shape, const AxlePose& pose, const Polyline& way,
                        double along, double look_ahead) {
  // beyond the way's end it goes straight on
  const double beyond = std::max(along + look_ahead - way.length(), 0.0);
  const Vec2 target = way.point_at(along + look_ahead) + beyond * way.direction_at(way.length());
  const Vec2 seen = to_body(target - pose.position, direction_of(pose.heading));
  const double distance = seen.squaredNorm();
  if (distance <= 0) return 0;
  return std::clamp(std::atan(shape.wheelbase * 2 * seen.y() / distance), -shape.max_steering,
                    shape.max_steering);
}

Vec2 rolling_velocity(const WheeledShape& shape, const AxlePose& pose, double speed,
                      double steering) {
  const double turning = speed * std::tan(steering) / shape.wheelbase;
  return from_body({speed, turning * shape.rear_axle_to_center}, direction_of(pose.heading));
}

bool is_in_the_way(const OrientedBox& ego, const OrientedBox& other, const EgoControl& control) {
  OrientedBox wide = ego;
  wide.half += Vec2((control.front_margin + control.side_margin) / 2, control.side_margin);
  wide.center += (control.front_margin - control.side_margin) / 2 * ego.forward;
  if ((other.center - wide.center).norm() > wide.half.norm() + other.half.norm()) return false;
  const Vec2 seen = to_body(other.center - ego.center, ego.forward);
  if (std::abs(std::atan2(seen.y(), seen.x())) > control.cone) return false;
  return separation(wide, other) < 0;
}

}  // namespace sumogamma
