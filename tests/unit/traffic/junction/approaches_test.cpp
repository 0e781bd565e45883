#include "traffic/junction/approaches.h"

#include <gtest/gtest.h>

#include "support/lights.h"
#include "support/road_scene.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;
using testing::show;

// two bicycles turned left, and the second stood in the way of a lane through all of its green: the
// first one, for which it waited, was in nobody's way and let everybody past
TEST(HoldingUp, SoDoesWhoeverThatOneStandsBehind) {
  RoadScene here{read_plain_net(crossroads("traffic_light"))};
  show(here, "EC_1", 'G');
  const std::size_t held = here.add("car", {"EC", "CW"}, 20, 0, 0, -1, "EC_1");
  const std::size_t second = here.add("bicycle", {"WC", "CN"}, 20, 0, 0, -1, "WC_1");
  const std::size_t first = here.add("bicycle", {"WC", "CN"}, 23, 0, 0, -1, "WC_1");
  const auto waits_for = [&](std::size_t row, LimitReason reason, std::size_t other) {
    here.scene.context[row].active = true;
    here.scene.context[row].reason = reason;
    here.scene.context[row].foe = static_cast<std::int64_t>(here.scene.id[other].value);
  };
  waits_for(held, LimitReason::Yield, second);
  here.scene.held[held].standing = 4.0;
  for (const LimitReason reason : {LimitReason::Leader, LimitReason::Yield}) {
    waits_for(second, reason, first);
    ApproachTable approaches;
    approaches.rebuild(here.view());
    EXPECT_TRUE(approaches.waiting(second).holds_up);
    EXPECT_EQ(approaches.waiting(first).holds_up, reason == LimitReason::Leader);
    EXPECT_FALSE(approaches.waiting(held).holds_up);
  }
}

TEST(ApproachTable, ListsWhoIsOnOrNearALinkForemostFirst) {
  RoadScene here(testing::small_net());
  const std::size_t far = here.add("car", {"in", "out"}, 5, 2);
  const std::size_t near = here.add("car", {"in", "out"}, 80, 5);
  const std::size_t on = here.add("car", {"in", "out"}, 100, 0.2);
  const std::size_t past = here.add("car", {"in", "out"}, 150, 5);
  here.update();
  const ConnectionId link = here.path(near).links.front().connection;
  const auto approaches = here.approaches.of(link);
  ASSERT_EQ(approaches.size(), 2u);
  EXPECT_EQ(approaches[0].row, on);
  EXPECT_NEAR(approaches[0].length, 4.5, 1e-9);
  EXPECT_TRUE(approaches[0].stands);
  EXPECT_EQ(approaches[1].row, near);
  EXPECT_NEAR(approaches[1].front, 80 + 2.25 - 95, 1e-9);
  EXPECT_FALSE(approaches[1].stands);
  EXPECT_TRUE(here.approaches.of(kNoConnection).empty());
  EXPECT_NE(far, past);
}

}  // namespace
}  // namespace sumogamma
