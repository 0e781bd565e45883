#include "sumo/edge_speeds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

class EdgeSpeedsTest : public ::testing::Test {
 protected:
  void put(const std::string& lane, double speed) {
    AgentState agent;
    agent.id = AgentId{static_cast<std::uint32_t>(scene_.size())};
    agent.footprint = box_footprint(4.5, 1.8);
    agent.path = static_cast<PathId>(agent.id.value);
    append_agent(scene_, agent);
    scene_.velocity.back() = Vec2(speed, 0);
    scene_.lane.back() = {network_.lane_by_name.at(lane), 50.0, 0.0};
  }

  RoadNetwork network_ = testing::read_plain_net(testing::two_ways(false));
  Scene scene_;
};

TEST_F(EdgeSpeedsTest, NobodyIsNoNews) {
  EdgeSpeeds speeds(network_);
  speeds.add(network_, scene_);
  EXPECT_TRUE(speeds.take_changes(network_).empty());
}

TEST_F(EdgeSpeedsTest, AQueueIsToldAsItLasts) {
  put("AS_0", 1.0);
  EdgeSpeeds speeds(network_);
  for (int second = 0; second < 90; ++second) speeds.add(network_, scene_);
  const auto changes = speeds.take_changes(network_);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(network_.edge(changes[0].first).name, "AS");
  // after the mean age of the average a 1 / e of the old speed is left
  const double length = network_.lane(network_.lane_by_name.at("AS_0")).length;
  EXPECT_NEAR(length / changes[0].second, 1.0 + 12.0 * std::exp(-1.0), 0.1);
  EXPECT_TRUE(speeds.take_changes(network_).empty()) << "told once";
  // and it goes away when they are gone
  scene_ = Scene{};
  for (int second = 0; second < 600; ++second) speeds.add(network_, scene_);
  const auto later = speeds.take_changes(network_);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_NEAR(length / later[0].second, 13.0, 0.1);
}

TEST_F(EdgeSpeedsTest, WhoHaltsByPlanHoldsNobodyUp) {
  put("AS_0", 0.0);
  scene_.halt.back().left = 20.0;
  EdgeSpeeds speeds(network_);
  for (int second = 0; second < 90; ++second) speeds.add(network_, scene_);
  EXPECT_TRUE(speeds.take_changes(network_).empty());
}

}  // namespace
}  // namespace sumogamma
