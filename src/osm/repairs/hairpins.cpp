#include "osm/repairs/hairpins.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace sumogamma::osm {
namespace {

constexpr double kTurn = radians(120.0);
constexpr double kArm = 10.0;   // [m] to either side of a tip, over which the turn is measured
constexpr double kNeck = 0.25;  // by which it narrows behind the bulb

/// The point of the line at least `kArm` from `from` as it is travelled, or its last one.
std::size_t arm_end(const std::vector<Vec2>& points, std::size_t from, int step) {
  double way = 0.0;
  std::size_t i = from;
  while (way < kArm && (step > 0 ? i + 1 < points.size() : i > 0)) {
    const std::size_t next = step > 0 ? i + 1 : i - 1;
    way += (points[next] - points[i]).norm();
    i = next;
  }
  return i;
}

/// How far the line turns at a point, from one arm to the other [rad]; 0 at its ends.
double turn_at(const std::vector<Vec2>& points, std::size_t i) {
  const Vec2 in = points[i] - points[arm_end(points, i, -1)];
  const Vec2 out = points[arm_end(points, i, 1)] - points[i];
  if (in.isZero() || out.isZero()) return 0.0;
  return std::abs(std::atan2(cross(in, out), in.dot(out)));
}

/// Where the line turns the most, and by enough to be a hairpin.
std::vector<std::size_t> find_tips(const std::vector<Vec2>& points) {
  std::vector<double> turns;
  for (std::size_t i = 0; i < points.size(); ++i) turns.push_back(turn_at(points, i));
  std::vector<std::size_t> tips;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto first = turns.begin() + static_cast<std::ptrdiff_t>(arm_end(points, i, -1));
    const auto last = turns.begin() + static_cast<std::ptrdiff_t>(arm_end(points, i, 1));
    if (turns[i] > kTurn &&
        std::max_element(first, last + 1) - turns.begin() == static_cast<std::ptrdiff_t>(i))
      tips.push_back(i);
  }
  return tips;
}

/// How far from the axis the line has to be so far behind the tip [m].
double half_width(double behind, double radius) {
  if (behind <= radius) return std::sqrt(std::max(0.0, behind * (2.0 * radius - behind)));
  return radius - kNeck * (behind - radius);
}

/// A point of an arm as it is seen from the tip.
struct ArmPoint {
  std::size_t index;
  double behind, aside;  ///< [m] along the axis, and to the left of it
};

/// The points of an arm up to `reach` behind the tip, the nearest first.
std::vector<ArmPoint> arm_of(const std::vector<Vec2>& points, const std::vector<double>& radii,
                             std::size_t tip, int step, const Vec2& axis, double reach) {
  constexpr double kDetour = 1.3;  // an arm that winds about for longer is the road beyond
  std::vector<ArmPoint> arm;
  double way = 0.0;
  for (std::size_t i = tip; step > 0 ? i + 1 < points.size() : i > 0;) {
    const std::size_t next = step > 0 ? i + 1 : i - 1;
    way += (points[next] - points[i]).norm();
    i = next;
    const Vec2 here = to_body(points[i] - points[tip], axis);
    if (radii[i] == 0.0 || here.x() > reach || way > kDetour * reach) break;
    arm.push_back({i, here.x(), here.y()});
  }
  return arm;
}

double mean_aside(const std::vector<ArmPoint>& arm) {
  double sum = 0.0;
  for (const ArmPoint& point : arm) sum += point.aside;
  return arm.empty() ? 0.0 : sum / static_cast<double>(arm.size());
}

void open_at(std::size_t tip, const std::vector<double>& radii, double radius,
             std::vector<Vec2>& points) {
  const Vec2 top = points[tip];
  const Vec2 before = (points[arm_end(points, tip, -1)] - top).normalized();
  const Vec2 after = (points[arm_end(points, tip, 1)] - top).normalized();
  const Vec2 axis = (before + after).normalized();
  const double reach = radius + radius / kNeck;
  const std::vector<ArmPoint> arms[] = {arm_of(points, radii, tip, -1, axis, reach),
                                        arm_of(points, radii, tip, 1, axis, reach)};
  // near the tip they may lie on each other, or cross
  double side = mean_aside(arms[0]) >= mean_aside(arms[1]) ? 1.0 : -1.0;
  for (const std::vector<ArmPoint>& arm : arms) {
    for (const ArmPoint& point : arm) {
      const double wanted = half_width(std::max(point.behind, 0.0), radius);
      if (point.aside * side < wanted)
        points[point.index] = top + from_body(Vec2(point.behind, side * wanted), axis);
    }
    side = -side;
  }
}

}  // namespace

std::vector<Vec2> open_hairpins(std::vector<Vec2> points, const std::vector<double>& radii,
                                double bulb) {
  for (const std::size_t tip : find_tips(points))
    if (radii[tip] > 0.0) open_at(tip, radii, bulb, points);
  return points;
}

}  // namespace sumogamma::osm
