#include <gtest/gtest.h>

#include "model/gamma_velocity.h"

namespace sumogamma {
namespace {

/// Two cars head on, 12 m apart, the second on ground of the given height.
Vec2 velocity_against(double height_of_other, LaneId lane = kNoLane) {
  Workers workers;
  Model model;
  model.types = default_agent_types();
  model.kinematics = build_kinematic_tables(model.types, workers);
  Scene scene;
  for (const double side : {-1.0, 1.0}) {
    AgentState car;
    car.id = {side < 0 ? 0u : 1u};
    car.type = find_agent_type(model.types, "car");
    car.footprint = box_footprint(4.5, 1.8);
    car.position = Vec2(6.0 * side, 0.0);
    car.heading = side < 0 ? 0.0 : 3.14159265358979;
    car.speed = car.preferred_speed = 8.0;
    car.behavior.intention.goal = Vec2(-100.0 * side, 0.0);
    car.behavior.attention = {15.0, 5.0};
    append_agent(scene, car);
  }
  scene.height[1] = height_of_other;
  scene.lane[0].lane = scene.lane[1].lane = lane;
  TickGeometry geometry;
  prepare_tick(model, scene, workers, geometry);
  Workspace work;
  return gamma_velocity(model, scene, geometry, 0, scene.behavior[0], work);
}

TEST(Storeys, AnAgentOnTheSameGroundIsAvoided) { EXPECT_LT(velocity_against(0.0).x(), 7.0); }

TEST(Storeys, AnAgentOnABridgeAboveIsNot) { EXPECT_NEAR(velocity_against(5.0).x(), 8.0, 1e-6); }

TEST(Storeys, OnALaneHoweverSteepItIs) { EXPECT_LT(velocity_against(5.0, LaneId{3}).x(), 7.0); }

}  // namespace
}  // namespace sumogamma
