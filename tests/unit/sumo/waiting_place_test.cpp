#include "sumo/waiting_place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/agent_type.h"
#include "scene/extent.h"
#include "sumo/ghosts.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

constexpr double kDt = 0.1;  // [s]

/// A road from A to B, 100 m to the east, with a pavement of 2 m (lane 0).
class WaitingPlace : public ::testing::Test {
 protected:
  void build(bool left_hand) {
    testing::PlainNet net;
    net.nodes = "<node id='A' x='0' y='0'/><node id='B' x='100' y='0'/>";
    net.edges = "<edge id='AB' from='A' to='B' numLanes='1' speed='13.9' sidewalkWidth='2'/>";
    if (left_hand) net.options = {"--lefthand", "true"};
    model_.types = default_agent_types();
    model_.road = testing::read_plain_net(net);
  }
  const Lane& lane(int index) const {
    const RoadNetwork& road = model_.road;
    return road.lane(road.edge(road.edge_by_name.at("AB")).lanes[static_cast<std::size_t>(index)]);
  }
  /// Somebody in the middle of a lane.
  std::size_t add(double along, int index = 0) {
    const AgentTypeTable types = default_agent_types();
    AgentState agent;
    agent.id = AgentId{static_cast<std::uint32_t>(scene_.size())};
    agent.type = find_agent_type(types, "pedestrian");
    const AgentType& type = type_of(types, agent.type);
    agent.footprint = box_footprint(type.length, type.width);
    agent.position = lane(index).centerline.point_at(along);
    append_agent(scene_, agent);
    scene_.lane.back().lane = model_.road.lane_by_name.at(lane(index).name);
    return scene_.size() - 1;
  }
  double offset(std::size_t row) const {
    return lane(0).centerline.project(scene_.position[row]).offset;
  }
  void wait(double seconds) {
    for (double time = 0; time < seconds; time += kDt)
      for (std::size_t row = 0; row < scene_.size(); ++row) {
        const Vec2 before = scene_.position[row];
        step_to_kerb(model_, scene_, row, kDt);
        EXPECT_LT((scene_.position[row] - before).norm(), 0.5 * kDt + 1e-9);
        EXPECT_NEAR(scene_.speed[row], (scene_.position[row] - before).norm() / kDt, 1e-9);
      }
  }
  Model model_;
  Scene scene_;
};

TEST_F(WaitingPlace, IsAtTheKerbOfEitherSide) {
  for (const bool left_hand : {false, true}) {
    build(left_hand);
    scene_ = {};
    const std::size_t row = add(50);
    wait(5);
    // towards the road, which is on the left where traffic keeps right
    EXPECT_GT(left_hand ? -offset(row) : offset(row), 0.4);
    EXPECT_LT(std::abs(offset(row)), 1.0);
    EXPECT_EQ(scene_.speed[row], 0.0);
  }
}

TEST_F(WaitingPlace, IsAStepBackWhereABusDrawsIn) {
  build(false);
  const std::size_t row = add(50);
  wait(5);
  const double at_kerb = offset(row);
  AgentState bus;
  bus.id = AgentId{7};
  bus.type = find_agent_type(model_.types, "bus");
  bus.footprint = box_footprint(12, 2.5);
  // its side 0.2 m from the kerb
  bus.position = lane(0).centerline.point_at(50) + Vec2(0, 1.0 + 0.2 + 1.25);
  append_agent(scene_, bus);
  const Vec2 place = scene_.position.back();
  wait(5);
  EXPECT_LT(offset(row), at_kerb - 0.15);
  EXPECT_GE(separation(box_of(scene_, row), box_of(scene_, 1)), 0.45);
  EXPECT_EQ(scene_.speed[row], 0.0) << "it stands there";
  scene_.position.back() = place + Vec2(30, 0);
  wait(5);
  EXPECT_NEAR(offset(row), at_kerb, 1e-9);
}

TEST_F(WaitingPlace, SeveralStandInARow) {
  build(false);
  for (const double along : {50.0, 49.0, 51.0}) {
    add(along);
    wait(3);
  }
  const std::size_t same = add(50);
  wait(10);
  for (std::size_t row = 0; row < scene_.size(); ++row) {
    EXPECT_GT(offset(row), 0.4) << row;
    EXPECT_FALSE(touches(scene_, row)) << row;
  }
  EXPECT_LT(scene_.position[same].x(), 49.9);  // behind who stands there
}

TEST_F(WaitingPlace, NobodyMovesOnTheRoad) {
  build(false);
  const std::size_t row = add(50, 1);
  const Vec2 before = scene_.position[row];
  wait(1);
  EXPECT_EQ(scene_.position[row], before);
  scene_.lane[row].lane = kNoLane;
  wait(1);
  EXPECT_EQ(scene_.position[row], before);
}

}  // namespace
}  // namespace sumogamma
