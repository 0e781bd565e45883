#include "ego/ego_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "support/ego_scene.h"

namespace sumogamma {
namespace {

using ::testing::HasSubstr;

TEST(StartDraw, SaysWhereNoWayLeadsToItsGoal) {
  const RoadNetwork network = testing::read_plain_net(testing::crossroads("priority"));
  const AgentTypeTable types = default_agent_types();
  const AgentType& car = type_of(types, find_agent_type(types, "car"));
  const auto refusal_of = [&](const std::string& lane, const std::string& goal) -> std::string {
    const Vec2 middle = network.lane(network.lane_by_name.at(lane)).centerline.point_at(100);
    EgoSettings settings;
    settings.window = {middle.x() - 1, middle.y() - 1, middle.x() + 1, middle.y() + 1};
    settings.goal_edge = goal;
    try {
      const StartDraw draw(network, car, settings);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal_of("WC_0", "CE"), "");
  EXPECT_THAT(refusal_of("CE_0", "CN"), HasSubstr("no way leads to 'CN' from the window"));
  EXPECT_THAT(refusal_of("WC_0", "NC"), HasSubstr("no way leads to 'NC' from the window"));
}

TEST(IsFree, AsksForABrakingWayOnlyOnWaysThatLeadOverTheStart) {
  const RoadNetwork network = testing::read_plain_net(testing::crossroads("priority"));
  const auto free_beside = [&](const std::string& lane, double along, double speed) {
    testing::RoadScene here(network);
    const std::string edge = lane.substr(0, 2);
    here.add("car", {edge, edge == "WC" ? "CE" : "CW"}, along, speed, 0, -1, lane);
    const Lane& own = network.lane(network.lane_by_name.at("WC_0"));
    EgoStart start;
    start.position = own.centerline.point_at(120);
    start.heading = heading_of(own.centerline.direction_at(120));
    const AgentType& car = type_of(here.model.types, find_agent_type(here.model.types, "car"));
    return is_free(here.scene, here.road, start, car, 9);
  };
  EXPECT_FALSE(free_beside("WC_0", 80, 14));  // comes from behind
  EXPECT_TRUE(free_beside("WC_0", 40, 14));
  EXPECT_TRUE(free_beside("WC_0", 80, 3));
  EXPECT_TRUE(free_beside("WC_0", 140, 14));   // has passed
  EXPECT_TRUE(free_beside("WC_1", 80, 14));    // stays in the lane beside
  EXPECT_FALSE(free_beside("WC_1", 103, 14));  // may change lanes before it has seen it
  EXPECT_TRUE(free_beside("EC_1", 90, 14));    // oncoming
  EXPECT_FALSE(free_beside("WC_1", 118, 0));
}

}  // namespace
}  // namespace sumogamma
