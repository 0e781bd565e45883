#include "planning/dubins.h"

#include <limits>
#include <optional>

namespace sumogamma {

namespace {

/// In (0, 2 pi], full turns that rounding makes of none taken off.
double turn_of(double angle) {
  const double turn = std::fmod(std::fmod(angle, 2 * M_PI) + 2 * M_PI, 2 * M_PI);
  return turn > 2 * M_PI - 1e-9 ? 0.0 : turn;
}

/// Middle of the circle that a pose is on where it turns to a side (+1 left, -1 right).
Vec2 middle_of(const AxlePose& pose, double radius, double side) {
  return pose.position + side * radius * left_of(direction_of(pose.heading));
}

/// Turn to a side, straight on, turn to another side.
std::optional<DubinsWay> over_tangent(const AxlePose& from, const AxlePose& to, double radius,
                                      double first, double last) {
  const Vec2 between = middle_of(to, radius, last) - middle_of(from, radius, first);
  const double distance = between.norm();
  double straight = distance, heading = heading_of(between);
  if (first != last) {
    if (distance < 2 * radius) return std::nullopt;
    straight = std::sqrt(std::max(distance * distance - 4 * radius * radius, 0.0));
    heading += first * std::atan2(2 * radius, straight);
  }
  if (distance < 1e-12) heading = from.heading;
  return DubinsWay{{{{radius * turn_of(first * (heading - from.heading)), first / radius},
                     {straight, 0},
                     {radius * turn_of(last * (to.heading - heading)), last / radius}}}};
}

/// Turn to a side, to the other one and to the first again. The middle circle touches both others
/// on one side or the other of the line through their middles (`beside`, +1 or -1).
std::optional<DubinsWay> over_circle(const AxlePose& from, const AxlePose& to, double radius,
                                     double side, double beside) {
  const Vec2 begin = middle_of(from, radius, side), end = middle_of(to, radius, side);
  const double distance = (end - begin).norm();
  if (distance > 4 * radius) return std::nullopt;
  const double bearing =
      heading_of(end - begin) + beside * std::acos(std::min(distance / (4 * radius), 1.0));
  const Vec2 middle = begin + 2 * radius * direction_of(bearing);
  const double leave = bearing + side * M_PI / 2;
  const double enter = heading_of(end - middle) - side * M_PI / 2;
  return DubinsWay{{{{radius * turn_of(side * (leave - from.heading)), side / radius},
                     {radius * turn_of(side * (leave - enter)), -side / radius},
                     {radius * turn_of(side * (to.heading - enter)), side / radius}}}};
}

}  // namespace

DubinsWay dubins_way(const AxlePose& from, const AxlePose& to, double radius) {
  DubinsWay best;
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&](const std::optional<DubinsWay>& way) {
    if (!way || way->length() >= least) return;
    least = way->length();
    best = *way;
  };
  for (const double first : {1.0, -1.0}) {
    for (const double last : {1.0, -1.0}) take(over_tangent(from, to, radius, first, last));
    for (const double beside : {1.0, -1.0}) take(over_circle(from, to, radius, first, beside));
  }
  return best;
}

}  // namespace sumogamma
