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

}  // namespace
}  // namespace sumogamma
