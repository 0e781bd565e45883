#include "scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "road/road_network.h"

namespace sumogamma {
namespace {

AgentState agent_at(std::uint32_t id, const Vec2& position, double heading = 0, double speed = 0) {
  AgentState agent;
  agent.id = {id};
  agent.footprint = box_footprint(4, 2);
  agent.position = position;
  agent.heading = heading;
  agent.speed = speed;
  return agent;
}

Scene three_agents() {
  Scene scene;
  append_agent(scene, agent_at(2, {0, 0}));
  append_agent(scene, agent_at(5, {10, 0}, 1.0, 3.0));
  append_agent(scene, agent_at(9, {20, 0}));
  return scene;
}

/// Every parallel array has as many entries as there are agents.
void expect_parallel(const Scene& scene) {
  const std::size_t n = scene.size();
  for (const std::size_t size :
       {scene.type.size(), scene.footprint.size(), scene.position.size(), scene.heading.size(),
        scene.velocity.size(), scene.speed.size(), scene.steering.size(), scene.acceleration.size(),
        scene.preferred_speed.size(), scene.behavior.size(), scene.manners.size(),
        scene.control.size(), scene.path.size(), scene.path_along.size(), scene.halt.size(),
        scene.held.size(), scene.lane.size(), scene.height.size(), scene.context.size()})
    EXPECT_EQ(size, n);
}

TEST(Scene, AppendsWholeRowsInOrderOfId) {
  const Scene scene = three_agents();
  ASSERT_EQ(scene.size(), 3u);
  expect_parallel(scene);
  EXPECT_EQ(scene.id[1], AgentId{5});
  EXPECT_NEAR(scene.velocity[1].x(), 3.0 * std::cos(1.0), 1e-12);
  EXPECT_NEAR(scene.velocity[1].y(), 3.0 * std::sin(1.0), 1e-12);
  EXPECT_EQ(scene.acceleration[1], Vec2(0, 0));
  EXPECT_EQ(scene.path[1], kNoPath);
  EXPECT_EQ(scene.lane[1].lane, kNoLane);
  EXPECT_FALSE(scene.context[1].active);
}

TEST(Scene, FindsRowsById) {
  const Scene scene = three_agents();
  EXPECT_EQ(find_row(scene, {2}), 0u);
  EXPECT_EQ(find_row(scene, {5}), 1u);
  EXPECT_EQ(find_row(scene, {9}), 2u);
  EXPECT_EQ(find_row(scene, {0}), 3u);
  EXPECT_EQ(find_row(scene, {6}), 3u);
  EXPECT_EQ(find_row(scene, {10}), 3u);
  EXPECT_EQ(find_row(Scene(), {0}), 0u);
}

TEST(Scene, RemovesRowsAndKeepsTheOrder) {
  Scene scene = three_agents();
  remove_agents(scene, {true, false, true});
  expect_parallel(scene);
  ASSERT_EQ(scene.size(), 1u);
  EXPECT_EQ(scene.id[0], AgentId{5});
  EXPECT_EQ(scene.position[0], Vec2(10, 0));
  EXPECT_EQ(scene.speed[0], 3.0);
  remove_agents(scene, {true});
  EXPECT_EQ(scene.size(), 0u);
  expect_parallel(scene);
}

TEST(Scene, ACopyIsItsOwn) {
  const Scene scene = three_agents();
  Scene fork = scene;
  fork.position[0] = {99, 99};
  EXPECT_EQ(scene.position[0], Vec2(0, 0));
  EXPECT_NE(hash_state(fork), hash_state(scene));
}

TEST(HashState, SeesEveryBitOfTheStateAndNothingElse) {
  const Scene scene = three_agents();
  std::set<std::uint64_t> hashes = {hash_state(scene)};
  auto expect_new = [&](auto&& change) {
    Scene changed = scene;
    change(changed);
    EXPECT_TRUE(hashes.insert(hash_state(changed)).second);
  };
  expect_new([](Scene& s) { s.position[1].x() = std::nextafter(s.position[1].x(), 1e9); });
  expect_new([](Scene& s) { s.position[1].y() = 1e-300; });
  expect_new([](Scene& s) { s.heading[2] = 1e-9; });
  expect_new([](Scene& s) { s.velocity[0].x() = 1; });
  expect_new([](Scene& s) { s.velocity[0].y() = 1; });
  expect_new([](Scene& s) { s.steering[0] = 0.1; });
  expect_new([](Scene& s) { s.id[2] = {10}; });
  expect_new([](Scene& s) { s.tick = 1; });
  expect_new([](Scene& s) { remove_agents(s, {false, false, true}); });
  Scene other = scene;
  other.time = 5;
  other.held[0].standing = 3;
  EXPECT_EQ(hash_state(other), hash_state(scene));
  // continued from another hash it is another one
  EXPECT_NE(hash_state(scene, 1), hash_state(scene));
}

TEST(Footprint, ABoxIsCounterClockwiseAboutItsCentre) {
  const Footprint box = box_footprint(4, 2);
  ASSERT_EQ(box.outline().size(), 4u);
  double area = 0;
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    area += 0.5 * cross(box.vertices[i], box.vertices[(i + 1) % 4]);
    sum += box.vertices[i];
  }
  EXPECT_NEAR(area, 8.0, 1e-12);
  EXPECT_EQ(sum, Vec2(0, 0));
  EXPECT_NEAR(box.radius, std::sqrt(5.0), 1e-12);
}

TEST(AgentTypes, TheBuiltInOnesAreSane) {
  const AgentTypeTable types = default_agent_types();
  std::set<std::string> names;
  for (const AgentType& type : types) {
    SCOPED_TRACE(type.name);
    EXPECT_TRUE(names.insert(type.name).second);
    EXPECT_NE(vehicle_class_from_name(type.sumo_class), vehicle_class::kOther);
    for (const double positive :
         {type.length, type.width, type.wheelbase, type.max_steering, type.max_steering_rate,
          type.max_speed, type.preferred_speed, type.max_acceleration,
          type.comfortable_deceleration, type.max_deceleration, type.max_lateral_acceleration,
          type.tracking_error, type.horizon, type.attention_front, type.attention_rear,
          type.headway, type.min_gap})
      EXPECT_GT(positive, 0.0);
    EXPECT_LE(type.preferred_speed, type.max_speed);
    EXPECT_LE(type.comfortable_deceleration, type.max_deceleration);
    EXPECT_LE(type.width, type.guided ? 4.0 : 2.55);
    EXPECT_LE(type.wheelbase, type.length);
    // the rear axle lies under the body
    EXPECT_LE(type.rear_axle_to_center, 0.5 * type.length);
    EXPECT_LE(type.attention_rear, type.attention_front);
  }
  EXPECT_EQ(names, (std::set<std::string>{"pedestrian", "bicycle", "motorcycle", "car", "van",
                                          "bus", "truck", "electric_tricycle", "gyro_scooter",
                                          "cargo_bicycle", "tram", "train", "ship"}));
}

TEST(AgentTypes, AreFoundByNameOrRefusedWithTheKnownOnes) {
  const AgentTypeTable types = default_agent_types();
  EXPECT_EQ(type_of(types, find_agent_type(types, "bus")).name, "bus");
  try {
    find_agent_type(types, "hovercraft");
    FAIL() << "found a hovercraft";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("hovercraft"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("pedestrian"));
  }
}

}  // namespace
}  // namespace sumogamma
