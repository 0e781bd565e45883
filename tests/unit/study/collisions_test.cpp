#include "study/collisions.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/units.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

class Collisions : public ::testing::Test {
 protected:
  void add(const char* type, const Vec2& position, double heading = 0) {
    AgentState agent;
    agent.id = AgentId{next_++};
    agent.type = find_agent_type(types_, type);
    agent.footprint =
        box_footprint(type_of(types_, agent.type).length, type_of(types_, agent.type).width);
    agent.position = position;
    agent.heading = heading;
    append_agent(scene_, agent);
  }
  CollisionResult result_after(int ticks = 1) {
    CollisionMonitor monitor(0.05);
    for (int i = 0; i < ticks; ++i) monitor.add(scene_, types_);
    return monitor.result();
  }

  AgentTypeTable types_ = default_agent_types();
  Scene scene_;
  std::uint32_t next_ = 0;
};

// cars are 4.5 x 1.8 m
TEST_F(Collisions, TouchingIsNotColliding) {
  add("car", {0, 0});
  add("car", {4.5, 0});
  add("car", {0, 1.8});
  EXPECT_EQ(result_after().unique_pairs, 0u);
}

TEST_F(Collisions, MeasuresPenetration) {
  add("car", {0, 0});
  add("car", {4.2, 0});
  const CollisionResult result = result_after();
  EXPECT_EQ(result.unique_pairs, 1u);
  EXPECT_EQ(result.deep_pairs, 1u);
  EXPECT_NEAR(result.worst_penetration_m, 0.3, 1e-9);
}

TEST_F(Collisions, ShallowIsNotDeep) {
  add("car", {0, 0});
  add("car", {4.45, 0});
  const CollisionResult result = result_after();
  EXPECT_EQ(result.unique_pairs, 1u);
  EXPECT_EQ(result.deep_pairs, 0u);
}

// two crossed boxes whose circles and bounding boxes overlap, but not they themselves
TEST_F(Collisions, OrientationMatters) {
  add("bus", {0, 0}, radians(45));
  add("bus", {5, -5}, radians(45));
  EXPECT_EQ(result_after().unique_pairs, 0u);
  add("bus", {0, 0}, radians(-45));
  EXPECT_EQ(result_after().unique_pairs, 2u);
}

TEST_F(Collisions, CountsAPairOnceAndItsTimeEveryTick) {
  add("pedestrian", {0, 0});
  add("car", {0.5, 0});
  add("car", {50, 0});
  const CollisionResult result = result_after(40);
  EXPECT_EQ(result.unique_pairs, 1u);
  EXPECT_EQ(result.by_types.at("car-pedestrian"), 1u);
  EXPECT_EQ(result.by_types.size(), 1u);
  EXPECT_DOUBLE_EQ(result.overlap_share_of_agent_steps, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(result.agent_hours, 3 * 40 * 0.05 / 3600);
  EXPECT_DOUBLE_EQ(result.unique_pairs_per_agent_hour, 1.0 / result.agent_hours);
}

TEST_F(Collisions, ReportsAPairFromItsBeginning) {
  add("car", {0, 0});
  add("car", {4, 0});
  CollisionMonitor monitor(0.05);
  monitor.add(scene_, types_);
  EXPECT_TRUE(monitor.overlapping()[0] && monitor.overlapping()[1]);
  scene_.position[1] = {3.5, 0};
  monitor.add(scene_, types_);
  scene_.position[1] = {3.8, 0};
  monitor.add(scene_, types_);
  ASSERT_EQ(monitor.pairs().size(), 1u);
  const CollisionPair& pair = monitor.pairs()[0];
  EXPECT_EQ(pair.a.value, 0u);
  EXPECT_EQ(pair.b.value, 1u);
  EXPECT_NEAR((pair.position - Vec2(2, 0)).norm(), 0, 1e-12) << "where it began";
  EXPECT_NEAR(pair.depth, 4.5 - 3.5, 1e-9) << "the deepest";
  EXPECT_NEAR(pair.duration, 0.15, 1e-12);
}

TEST_F(Collisions, BridgesKeepAgentsApart) {
  const RoadNetwork net = testing::small_net();
  add("car", {50, 0});
  add("car", {50, 0}, kPi / 2);
  scene_.lane[0] = {net.lane_by_name.at("in_1"), 50, 0};
  scene_.lane[1] = {net.lane_by_name.at("bridge_0"), 60, 0};
  CollisionMonitor monitor(0.05, &net);
  monitor.add(scene_, types_);
  EXPECT_EQ(monitor.result().unique_pairs, 0u);
  scene_.lane[1] = scene_.lane[0];
  monitor.add(scene_, types_);
  EXPECT_EQ(monitor.result().unique_pairs, 1u);
}

TEST_F(Collisions, EmptyRunIsAllZero) {
  const CollisionResult result = result_after();
  EXPECT_EQ(result.unique_pairs, 0u);
  EXPECT_EQ(result.unique_pairs_per_agent_hour, 0.0);
  EXPECT_EQ(result.overlap_share_of_agent_steps, 0.0);
}

// law: the sweep finds the same pairs as testing everyone against everyone
TEST_F(Collisions, SweepAgreesWithAllPairs) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    scene_ = Scene{};
    next_ = 0;
    for (std::uint64_t i = 0; i < 60; ++i) {
      const std::size_t type = random_bits(seed, i, 0, Draw::Demand) % types_.size();
      add(types_[type].name.c_str(),
          {random_uniform(seed, i, 1, Draw::Demand, 0, 50),
           random_uniform(seed, i, 2, Draw::Demand, 0, 50)},
          random_uniform(seed, i, 3, Draw::Demand, -kPi, kPi));
    }
    std::size_t expected = 0;
    for (std::size_t a = 0; a < scene_.size(); ++a)
      for (std::size_t b = a + 1; b < scene_.size(); ++b) {
        const auto one =
            place_polygon(scene_.footprint[a].outline(), direction_of(scene_.heading[a]));
        const auto other =
            place_polygon(scene_.footprint[b].outline(), direction_of(scene_.heading[b]));
        expected += overlap_depth(one, other, scene_.position[b] - scene_.position[a]) >
                    CollisionMonitor::kContact;
      }
    EXPECT_GT(expected, 0u);
    EXPECT_EQ(result_after().unique_pairs, expected);
  }
}

}  // namespace
}  // namespace sumogamma
