#include "scene/locate.h"

#include <gtest/gtest.h>

#include "support/road_scene.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::RoadScene;

TEST(LocateOnPath, TellsLaneAlongAndOffset) {
  RoadScene here(testing::small_net());
  const std::size_t own = here.add("car", {"in", "out"}, 50, 5);
  here.scene.position[own] += Vec2(2.0, 0.4);
  EXPECT_NEAR(locate_on_path(here.model.road, here.road, here.scene, own), 0.4, 1e-9);
  EXPECT_NEAR(here.scene.path_along[own], 52.0, 1e-9);
  EXPECT_EQ(here.model.road.lane(here.scene.lane[own].lane).name, "in_1");
  EXPECT_NEAR(here.scene.lane[own].along, 52.0, 1e-9);
  EXPECT_NEAR(here.scene.lane[own].offset, 0.4, 1e-9);
  EXPECT_NEAR(here.scene.height[own], 0.0, 1e-9);
}

TEST(LocateOnPath, CountsLanePlacesBackwardsWhereAWalkerGoesBackwards) {
  RoadScene here(testing::small_net());
  const std::size_t own = here.add("pedestrian", {"in"}, 10, 1, 80, 20);
  ASSERT_TRUE(here.path(own).stretches.front().reversed);
  here.scene.position[own] += Vec2(0, 0.3);  // walking west: north is to the right
  EXPECT_NEAR(locate_on_path(here.model.road, here.road, here.scene, own), -0.3, 1e-9);
  EXPECT_NEAR(here.scene.lane[own].along, 70.0, 1e-9);
  EXPECT_NEAR(here.scene.lane[own].offset, 0.3, 1e-9);
}

TEST(LocateOnPath, FollowsAPathThatCrossesItselfInOrder) {
  RoadScene here(testing::small_net());
  Path loop;
  loop.line = Polyline({{0, 0}, {40, 0}, {40, 20}, {20, 20}, {20, -30}});
  loop.stretches.push_back({});
  loop.stretches.back().lane = here.model.road.lane_by_name.at("in_1");
  loop.stretches.back().to = loop.line.length();
  const auto car = find_agent_type(here.model.types, "car");
  const std::size_t own = here.add(car, std::make_shared<const Path>(loop), 15, 5);
  for (double along = 15; along < 120; along += 0.5) {
    here.scene.position[own] = loop.line.point_at(along);
    locate_on_path(here.model.road, here.road, here.scene, own);
    EXPECT_NEAR(here.scene.path_along[own], along, 1e-9);
  }
}

// somebody went to and fro for five minutes where its way went into a corner and out again
TEST(LocateOnPath, WhoIsOnFootAndPastAFoldOfItsWayStaysPastIt) {
  RoadScene here(testing::small_net());
  Path fold;
  fold.walking = true;
  fold.line = Polyline({{0, 0}, {10, 0}, {10, 0.1}, {0, 0.6}});
  fold.stretches.push_back({});
  fold.stretches.back().lane = here.model.road.lane_by_name.at("in_0");
  fold.stretches.back().to = fold.line.length();
  const auto pedestrian = find_agent_type(here.model.types, "pedestrian");
  const std::size_t own = here.add(pedestrian, std::make_shared<const Path>(fold), 11.5, 1);
  here.scene.position[own] = Vec2(8.6, 0.05);  // nearer to the way into the corner
  locate_on_path(here.model.road, here.road, here.scene, own);
  EXPECT_NEAR(here.scene.path_along[own], 11.5, 0.2);
}

TEST(LocateOnPath, KeepsUpAtTheLongestStepAndTheHighestSpeed) {
  // --step allows 0.5 s; a motorcycle may do 50 m/s: 25 m a tick
  RoadScene here(testing::small_net());
  const std::size_t own = here.add("motorcycle", {"in", "out"}, 2, 50);
  for (double along = 2; along < 195; along += 25) {
    here.scene.position[own] = here.path(own).line.point_at(along);
    locate_on_path(here.model.road, here.road, here.scene, own);
    EXPECT_NEAR(here.scene.path_along[own], along, 1e-9);
  }
}

TEST(LocateOnPath, LeavesAgentsWithoutAPathAlone) {
  RoadScene here(testing::small_net());
  const std::size_t own = here.add("car", {"in", "out"}, 50, 5);
  here.scene.path[own] = kNoPath;
  here.scene.path_along[own] = 7;
  EXPECT_EQ(locate_on_path(here.model.road, here.road, here.scene, own), 0.0);
  EXPECT_EQ(here.scene.path_along[own], 7);
}

}  // namespace
}  // namespace sumogamma
