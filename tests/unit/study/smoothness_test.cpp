#include <gtest/gtest.h>

#include <functional>

#include "base/units.h"
#include "study/smoothness_metrics.h"

namespace sumogamma {
namespace {

constexpr double kFineStep = 0.05;

struct Pose {
  Vec2 position;
  double heading;
};

/// One agent of a type whose pose is a function of time.
SmoothnessResult measure(const char* type_name, const std::function<Pose(double)>& pose_at,
                         double duration = 10) {
  const AgentTypeTable types = default_agent_types();
  SmoothnessMonitor monitor(kFineStep);
  Scene scene;
  AgentState agent;
  agent.type = find_agent_type(types, type_name);
  agent.footprint = box_footprint(1, 1);
  append_agent(scene, agent);
  for (int tick = 0; tick * kFineStep <= duration; ++tick) {
    const Pose pose = pose_at(tick * kFineStep);
    scene.position[0] = pose.position;
    scene.heading[0] = pose.heading;
    monitor.add(scene, types);
  }
  return monitor.result(types);
}

TEST(Smoothness, UniformMotionIsPerfect) {
  const auto result = measure("car", [](double t) { return Pose{{10 * t, 0}, 0}; });
  EXPECT_NEAR(result.wheeled.accel_p95, 0, 0.021);
  EXPECT_NEAR(result.wheeled.jerk_p95, 0, 0.51);
  EXPECT_EQ(result.wheeled.yaw_rate_p95, 0);
  EXPECT_NEAR(result.wheeled.lateral_slip_p95, 0, 1e-9);
  EXPECT_EQ(result.wheeled.reversals, 0u);
}

TEST(Smoothness, ConstantAcceleration) {
  const auto result = measure("car", [](double t) { return Pose{{t * t, 0}, 0}; });
  EXPECT_NEAR(result.wheeled.accel_p95, 2.0, 0.03);
  EXPECT_NEAR(result.wheeled.jerk_p95, 0, 0.51);
}

// a car whose rear axle rolls on a circle: its centre drifts outwards, but nothing slips
TEST(Smoothness, RollingInACircleIsNoSlip) {
  const double radius = 15, speed = 6, rate = speed / radius;
  const double to_center =
      type_of(default_agent_types(), find_agent_type(default_agent_types(), "car"))
          .rear_axle_to_center;
  const auto result = measure("car", [&](double t) {
    const double heading = rate * t;
    const Vec2 axle = radius * Vec2(std::sin(heading), -std::cos(heading));
    return Pose{axle + to_center * direction_of(heading), wrap_angle(heading)};
  });
  EXPECT_NEAR(result.wheeled.yaw_rate_p95, rate, 0.006);
  EXPECT_NEAR(result.wheeled.lateral_slip_p95, 0, 0.003);
}

TEST(Smoothness, SideslipIsSeen) {
  const auto result = measure("car", [](double t) { return Pose{{8 * t, 0.7 * t}, 0}; });
  EXPECT_NEAR(result.wheeled.lateral_slip_p95, 0.7, 0.003);
}

TEST(Smoothness, ReversalsAreCountedOnceEach) {
  // forth and back twice
  const auto result = measure("car", [](double t) {
    return Pose{{3 * std::sin(2 * kPi * t / 5), 0}, 0};
  });
  EXPECT_EQ(result.wheeled.reversals, 2u);
}

TEST(Smoothness, PedestriansAreKeptApart) {
  const auto result = measure("pedestrian", [](double t) { return Pose{{0, 1.3 * t}, 0}; });
  EXPECT_EQ(result.wheeled.agent_steps, 0u);
  EXPECT_GT(result.by_type.at("pedestrian").agent_steps, 100u);
  EXPECT_EQ(result.by_type.at("pedestrian").lateral_slip_p95, 0);
}

TEST(Smoothness, TeleportsAndStandingDoNotCount) {
  const auto jump = measure("car", [](double t) {
    return Pose{{t < 5 ? 10 * t : 10 * t + 500, 0}, 0};
  });
  EXPECT_NEAR(jump.wheeled.accel_p95, 0, 0.021);
  const auto standing = measure("car", [](double) { return Pose{{1, 2}, 0.3}; });
  EXPECT_EQ(standing.wheeled.agent_steps, 0u);
}

}  // namespace
}  // namespace sumogamma
