#include "traffic/recovery/lost_way.h"

#include <gtest/gtest.h>

#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::read_plain_net;
using testing::RoadScene;
using testing::two_ways;

/// Drives a row straight on for `way` [m] without regard to its path.
void drive_straight_on(RoadScene& here, std::size_t row, double way) {
  constexpr double kStep = 0.5, kDt = 0.05;  // [m], [s]
  const Vec2 forward = direction_of(here.scene.heading[row]);
  here.scene.velocity[row] = kStep / kDt * forward;
  Workers alone;
  for (double driven = 0.0; driven < way; driven += kStep) {
    here.scene.position[row] += kStep * forward;
    const double before = here.scene.path_along[row];
    locate_on_path(here.model.road, here.road, here.scene, row);
    note_progress(TrafficParameters{}, before, kDt, here.scene, here.traffic, row);
    find_ways_back(here.tick(alone));
  }
}

/// Puts `own` on the way of `other`, though its path leads another way.
void lead_astray(RoadScene& here, std::size_t own, std::size_t other) {
  const Path& path = here.path(other);
  const double place = path.links.front().end + 2.0;
  here.scene.path_along[own] = here.path(own).links.front().stop_line;
  here.scene.position[own] = path.line.point_at(place);
  here.scene.heading[own] = heading_of(path.line.direction_at(place));
}

// In Volgograd a car was carried past the turn of its path, which led backwards, and drove on for
// 159 m against the traffic and over grass: its place on the path stood still.
TEST(LostWay, WhoseWayLedWhereItCouldNotGoTakesAnotherFromTheLaneThatItIsOn) {
  RoadScene here(read_plain_net(two_ways(false)));
  const std::size_t own = here.add("car", {"IA", "AN", "ND", "DO"}, 0, 10);
  const std::size_t other = here.add("car", {"IA", "AS", "SD", "DO"}, 0, 10);
  // it comes onto the road to the south, though it meant to go by the north
  lead_astray(here, own, other);
  const auto name_at = [&] { return here.model.road.lane(here.scene.lane[own].lane).name; };
  drive_straight_on(here, own, 8.0);
  EXPECT_NE(name_at(), "AS_0") << "it hasn't driven far";
  drive_straight_on(here, own, 12.0);
  EXPECT_EQ(name_at(), "AS_0");
  const Path& path = here.path(own);
  EXPECT_EQ(here.model.road.edge(path.trip->route.back()).name, "DO") << "the same destination";
  EXPECT_LT(here.traffic.strayed[own], 6.0);
}

// in a forecast paths don't lie in order of ids
TEST(LostWay, ANewWayLiesWhereTheOldOneLayAndNowhereElse) {
  RoadScene here(read_plain_net(two_ways(false)));
  const std::size_t own = here.add("car", {"IA", "AN", "ND", "DO"}, 0, 10);
  const std::size_t other = here.add("car", {"IA", "AS", "SD", "DO"}, 0, 10);
  std::swap(here.road.paths[static_cast<std::size_t>(here.scene.path[own])],
            here.road.paths[static_cast<std::size_t>(here.scene.path[other])]);
  std::swap(here.scene.path[own], here.scene.path[other]);
  const Path* const meant = here.road.path(here.scene.path[own]);
  const Path* const theirs = here.road.path(here.scene.path[other]);
  lead_astray(here, own, other);
  drive_straight_on(here, own, 20.0);
  EXPECT_NE(here.road.path(here.scene.path[own]), meant);
  EXPECT_EQ(here.road.path(here.scene.path[other]), theirs);
}

TEST(LostWay, WhoIsOnItsOwnPathFurtherOnGoesOnFromThere) {
  RoadScene here(read_plain_net(two_ways(false)));
  const std::size_t own = here.add("car", {"IA", "AN", "ND", "DO"}, 0, 10);
  const PathLink& first = here.path(own).links.front();
  here.move(own, first.end + 20.0);
  here.scene.path_along[own] = first.stop_line - 10.0;
  const auto before = here.road.path(here.scene.path[own]);
  drive_straight_on(here, own, 14.0);
  EXPECT_EQ(here.road.path(here.scene.path[own]), before) << "the same path";
  EXPECT_GT(here.scene.path_along[own], first.end + 20.0);
}

TEST(LostWay, WhoFollowsItsPathBesideItOrRoundABendIsNotLost) {
  RoadScene here(read_plain_net(two_ways(false)));
  const std::size_t own = here.add("car", {"IA", "AN", "ND", "DO"}, 0, 10);
  for (double along = 0.0; along < here.path(own).arrival; along += 0.5) {
    const double before = here.scene.path_along[own];
    here.move(own, along, -1.5);
    here.scene.path_along[own] = before;
    locate_on_path(here.model.road, here.road, here.scene, own);
    note_progress(TrafficParameters{}, before, 0.05, here.scene, here.traffic, own);
    ASSERT_LT(here.traffic.strayed[own], 4.0) << along;
  }
}

}  // namespace
}  // namespace sumogamma
