#include "planning/pursuit.h"

#include <gtest/gtest.h>

#include "model/tracking.h"

namespace sumogamma {
namespace {

AgentType car_type() {
  const AgentTypeTable types = default_agent_types();
  return type_of(types, find_agent_type(types, "car"));
}

/// Drives a car along a way by its own controller; the farthest that its axle gets off it [m].
double farthest_off(const Polyline& way, Vec2 start, double heading, double speed, double until) {
  const AgentType type = car_type();
  const WheeledShape shape = wheeled_shape(type);
  BodyState body{start + shape.rear_axle_to_center * direction_of(heading), heading,
                 speed * direction_of(heading), speed, 0};
  double off = 0;
  for (;;) {
    const AxlePose pose{body.position - shape.rear_axle_to_center * direction_of(body.heading),
                        body.heading};
    const PolylinePosition at = way.project(pose.position);
    if (at.along >= until) return off;
    if (at.along > until / 3) off = std::max(off, at.distance);
    const double steering = pursuit_steering(shape, pose, way, at.along, 5.0);
    body = advance_body(type, body, rolling_velocity(shape, pose, speed, steering), 0.05);
  }
}

TEST(Pursuit, ComesOntoItsWayAndStaysThere) {
  const Polyline straight({Vec2(0, 0), Vec2(90, 0)});
  EXPECT_LT(farthest_off(straight, Vec2(0, 1.5), 0, 6, 80), 0.3);
  std::vector<Vec2> points;
  for (int i = 0; i <= 90; ++i)
    points.push_back(15 * Vec2(std::sin(i * M_PI / 60), 1 - std::cos(i * M_PI / 60)));
  EXPECT_LT(farthest_off(Polyline(points), Vec2(0, 0), 0, 5, 60), 0.5);
}

TEST(Pursuit, SteersTowardsTheSideOnWhichItsWayLies) {
  const WheeledShape shape = wheeled_shape(car_type());
  const Polyline way({Vec2(0, 0), Vec2(90, 0)});
  EXPECT_GT(pursuit_steering(shape, {Vec2(10, -2), 0}, way, 10, 5), 0.05);
  EXPECT_LT(pursuit_steering(shape, {Vec2(10, 2), 0}, way, 10, 5), -0.05);
  EXPECT_NEAR(pursuit_steering(shape, {Vec2(10, 0), 0}, way, 10, 5), 0, 1e-12);
  EXPECT_NEAR(pursuit_steering(shape, {Vec2(89, 0), 0}, way, 89, 5), 0, 1e-12);  // beyond the end
  EXPECT_LE(pursuit_steering(shape, {Vec2(10, -2), -1.5}, way, 10, 5), shape.max_steering);
}

TEST(InTheWay, IsWhatIsAheadAndNear) {
  const OrientedBox ego{Vec2(0, 0), Vec2(1, 0), Vec2(2, 0.9)};
  const auto other = [](double x, double y) {
    return OrientedBox{Vec2(x, y), Vec2(0, 1), Vec2(0.3, 0.3)};
  };
  const EgoControl control;
  // the front is at 2, its margin ends at 5; the side's at 1.7
  EXPECT_TRUE(is_in_the_way(ego, other(5.2, 0), control));
  EXPECT_FALSE(is_in_the_way(ego, other(5.4, 0), control));
  EXPECT_TRUE(is_in_the_way(ego, other(4, 1.9), control));
  EXPECT_FALSE(is_in_the_way(ego, other(4, 2.1), control));
  EXPECT_FALSE(is_in_the_way(ego, other(-2.5, 0), control));
  EXPECT_FALSE(is_in_the_way(ego, other(0.5, 1.5), control));  // beside, beyond 60 degrees
}

}  // namespace
}  // namespace sumogamma
