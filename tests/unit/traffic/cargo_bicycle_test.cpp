// A type of its own is a cyclist without a word about it in the rules.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/lane_looks.h"
#include "support/open_scene.h"
#include "support/plain_net.h"
#include "support/road_scene.h"
#include "traffic/lateral/passing.h"

namespace sumogamma {
namespace {

using testing::read_plain_net;
using testing::RoadScene;

constexpr const char* kType = "cargo_bicycle";

TEST(CargoBicycle, FiltersBetweenQueues) {
  RoadScene here{read_plain_net(testing::two_lanes())};
  for (const char* lane : {"WE_0", "WE_1"})
    for (const double along : {80.0, 87.0}) here.add("car", {"WE"}, along, 0, 0, -1, lane);
  const std::size_t rider = here.add(kType, {"WE"}, 66, 5, 0, -1, "WE_0");
  here.update();
  Surroundings around;
  look_around(here.view(), rider, 60.0, 8.0, around);
  EXPECT_NEAR(passing_offset(here.view(), here.path(rider), around, rider), 1.75, 1e-6);
}

TEST(CargoBicycle, FollowsWhoIsAheadInItsFile) {
  RoadScene here{read_plain_net(testing::two_lanes())};
  const std::size_t ahead = here.add("bicycle", {"WE"}, 70, 2, 0, -1, "WE_0");
  const std::size_t rider = here.add(kType, {"WE"}, 66, 5, 0, -1, "WE_0");
  here.update();
  EXPECT_EQ(here.context(rider).reason, LimitReason::Leader);
  EXPECT_EQ(here.context(rider).foe, here.scene.id[ahead].value);
  EXPECT_LT(here.context(rider).allowed_speed, 5.0);
}

TEST(CargoBicycle, TurnsBesideTheKerbAndStaysOnItsWay) {
  RoadScene here{read_plain_net(testing::crossroads("priority"))};
  const std::size_t rider = here.add(kType, {"SC", "CE"}, 0, 4);
  const PathLink link = here.path(rider).links.front();
  here.move(rider, link.stop_line - 10.0);
  double farthest = 0.0;
  for (int tick = 0; tick < 600 && here.scene.path_along[rider] < link.end + 8.0; ++tick) {
    here.update();
    test::step(here.model, here.scene, 0.05);
    const Polyline& way = here.path(rider).line;
    farthest = std::max(farthest, way.project(here.scene.position[rider]).distance);
  }
  EXPECT_GT(here.scene.path_along[rider], link.end + 8.0);
  EXPECT_LT(farthest, 0.8);
}

}  // namespace
}  // namespace sumogamma
