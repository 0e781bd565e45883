#include "traffic/walking/walking_place.h"

#include <gtest/gtest.h>

#include "model/gamma_velocity.h"
#include "model/tracking.h"
#include "support/lane_looks.h"
#include "support/road_scene.h"
#include "traffic/patience.h"

namespace sumogamma {
namespace {

using testing::PlainNet;
using testing::read_plain_net;
using testing::RoadScene;

//   y = 1.5   -------------------------------
//              row 0 ->             <- others       a sidewalk of 3 m, 60 m long
//   y = -1.5  -------------------------------
class WalkingPlaceTest : public ::testing::Test {
 protected:
  static RoadNetwork sidewalk() {
    PlainNet plain;
    plain.nodes = "<node id='W' x='0' y='0'/><node id='E' x='60' y='0'/>";
    plain.edges =
        "<edge id='walk' from='W' to='E' numLanes='1' allow='pedestrian' width='3' "
        "spreadType='center'/>";
    return read_plain_net(plain);
  }
  /// Somebody at x [m] and `offset` to the left of the eastward path, who walks with `speed`, west
  /// where it is negative.
  std::size_t walker(double x, double offset, double speed) {
    const bool east = speed >= 0;
    const std::size_t row = here_.add("pedestrian", {"walk"}, east ? x : 60 - x, std::abs(speed),
                                      east ? 0 : 60, east ? 60 : 0);
    here_.move(row, east ? x : 60 - x, east ? offset : -offset);
    return row;
  }
  /// A vehicle with a body that stands across the way, its middle at x [m] and `offset` to the
  /// left.
  void put_across(const std::string& type, const Footprint& body, double x, double offset) {
    const std::size_t row = walker(x, offset, 0.0);
    here_.scene.path[row] = kNoPath;
    here_.scene.type[row] = find_agent_type(here_.model.types, type);
    here_.scene.footprint[row] = body;
    here_.scene.heading[row] = 0.5 * kPi;
  }
  /// A tick of one who walks.
  void walk(std::size_t row) {
    testing::let_all_look(here_);
    here_.update();
    const Vec2 asked = gamma_velocity(here_.model, here_.scene, here_.geometry, row,
                                      here_.scene.behavior[row], work_);
    place_body(track_velocity(here_.model, here_.scene, row, asked, 0.05), here_.scene, row);
  }
  /// Over the right side of the eastward way, up to `top`.
  void put_wall(double west, double east, double top) {
    Obstacle wall;
    wall.outline = {{west, -1.5}, {east, -1.5}, {east, top}, {west, top}};
    here_.model.road.obstacles = {wall};
    here_.model.obstacles = ObstacleIndex(here_.model.road.obstacles);
  }
  double place_of(std::size_t row) {
    here_.update();
    look_around(here_.view(), row, 8, 2.5, around_);
    look_at_walls(here_.view(), here_.path(row), row, 4, 2.5, around_);
    return walking_place(here_.view(), here_.path(row), around_, row);
  }
  RoadScene here_{sidewalk()};
  Surroundings around_;
  Workspace work_;
};

TEST_F(WalkingPlaceTest, WhoIsAloneWalksWhereItLikesToBe) {
  const std::size_t own = walker(10, 0, 1.3);
  here_.scene.manners[own].path_offset = -0.6;
  EXPECT_NEAR(place_of(own), -0.6, 1e-9);
}

// in Berlin somebody who was alone pressed on against the tip of a crossing for 61 s of red
TEST_F(WalkingPlaceTest, WhoIsHeldUpByTheTipOfARedCrossingGoesRoundIt) {
  const std::size_t own = walker(10, 0, 1.3);
  auto place_before_a_tip = [&](double waited, LimitReason reason) {
    here_.update();
    here_.traffic.waiting_time[own] = waited;
    here_.scene.context[own].reason = reason;
    here_.scene.context[own].to_red[0] = {0.1, -0.1};
    look_around(here_.view(), own, 8, 2.5, around_);
    look_at_walls(here_.view(), here_.path(own), own, 4, 2.5, around_);
    look_at_red_crossings(here_.view(), here_.path(own), own, around_);
    return walking_place(here_.view(), here_.path(own), around_, own);
  };
  EXPECT_GT(place_before_a_tip(6.0, LimitReason::None), 0.3);
  EXPECT_NEAR(place_before_a_tip(3.5, LimitReason::None), 0.0, 1e-9) << "not at once";
  EXPECT_NEAR(place_before_a_tip(20.0, LimitReason::Signal), 0.0, 1e-9) << "it waits for it";
}

TEST_F(WalkingPlaceTest, APlaceThatTheSidewalkDoesNotHaveIsNotAimedAt) {
  const std::size_t own = walker(10, 0, 1.3);
  here_.scene.manners[own].path_offset = -4.0;
  EXPECT_GT(place_of(own), -1.5 + 0.24);
}

TEST_F(WalkingPlaceTest, WhoIsBehindSomebodySlowPasses) {
  const std::size_t own = walker(10, -0.4, 1.3);
  here_.scene.manners[own].path_offset = here_.traffic.passing_offset[own] = -0.4;
  walker(12, -0.4, 0.4);
  EXPECT_GT(std::abs(place_of(own) + 0.4), 0.48);
}

TEST_F(WalkingPlaceTest, NobodyPassesWhereOthersCome) {
  const std::size_t own = walker(10, -0.7, 1.3);
  here_.scene.manners[own].path_offset = here_.traffic.passing_offset[own] = -0.7;
  walker(12, -0.7, 0.9);
  for (const double x : {11.0, 12.5, 14.0, 15.5})
    for (const double offset : {0.1, 0.7}) walker(x, offset, -1.3);
  EXPECT_LT(place_of(own), -0.5);
}

TEST_F(WalkingPlaceTest, WhoMeetsAStreamFollowsThoseWhoWalkItsOwnWay) {
  const std::size_t own = walker(10, 0.5, 1.3);
  here_.traffic.passing_offset[own] = 0.5;
  here_.scene.manners[own].path_offset = 0.5;
  walker(14, 0.5, -1.3);
  walker(13, 0.9, -1.3);
  walker(12, -0.6, 1.1);  // its own way
  EXPECT_LT(place_of(own), 0.0);
}

TEST_F(WalkingPlaceTest, NobodyAimsAtAWall) {
  put_wall(12, 14, -0.2);
  const std::size_t own = walker(10, -0.8, 1.3);
  here_.scene.manners[own].path_offset = here_.traffic.passing_offset[own] = -0.8;
  EXPECT_GT(place_of(own), -0.2 + 0.24);
}

// between the corners of two houses somebody pressed against a wall for six minutes
TEST_F(WalkingPlaceTest, WhoIsCaughtInANookMakesForTheMiddleOfItsWay) {
  put_wall(10.5, 14, -0.6);
  const std::size_t own = walker(10, -1.0, 0.0);
  here_.traffic.lateral_aim[own] = -1.0;
  const auto goal_after = [&](double waited) {
    here_.traffic.waiting_time[own] = waited;
    here_.update();
    return here_.context(own).sub_goal;
  };
  EXPECT_GT(goal_after(5.0).x(), 10.5);
  EXPECT_LT((goal_after(12.0) - Vec2(10.5, 0.0)).norm(), 0.1);
}

// at the corner of a house that it could see past somebody shuffled for two minutes
TEST_F(WalkingPlaceTest, WhoSeesItsGoalPastACornerButDoesNotFitPastItIsCaughtToo) {
  put_wall(10.5, 11, -0.6);
  const std::size_t own = walker(10, -0.5, 0.0);
  here_.traffic.waiting_time[own] = 12.0;
  here_.traffic.lateral_aim[own] = -0.5;
  here_.update();
  const Vec2 past_it(12, -0.5);
  ASSERT_FALSE(here_.model.obstacles.is_between(here_.scene.position[own], past_it));
  EXPECT_LT((here_.context(own).sub_goal - Vec2(10.5, 0.0)).norm(), 0.1);
  here_.move(own, 10, -0.3);
  here_.traffic.lateral_aim[own] = -0.3;
  here_.update();
  EXPECT_GT(here_.context(own).sub_goal.x(), 10.5) << "it fits";
}

// somebody and a bus that stood across the sidewalk waited for each other for minutes
TEST_F(WalkingPlaceTest, WhoHasWaitedLongBeforeAVehicleWalksRoundIt) {
  const std::size_t own = walker(10, 0, 0.2);
  const std::size_t car =
      here_.add(find_agent_type(here_.model.types, "car"),
                here_.road.paths[static_cast<std::size_t>(here_.scene.path[own])], 12, 0);
  here_.scene.heading[car] = 0.5 * kPi;
  here_.set_speed(car, 0);
  EXPECT_LT(std::abs(place_of(own)), 1.5) << "on the sidewalk";
  here_.traffic.waiting_time[own] = 6;
  EXPECT_GT(std::abs(place_of(own)), 2.25);
}

// Before a crossing there may be room off the ways of those who drive on one side only.
TEST_F(WalkingPlaceTest, WhoMayHaveToWaitKeepsToTheSideWhereNobodyDrives) {
  const std::size_t own = walker(10, -0.6, 1.3);
  here_.scene.manners[own].path_offset = here_.traffic.passing_offset[own] = -0.6;
  EXPECT_NEAR(place_of(own), -0.6, 1e-9);
  Path path = here_.path(own);
  PathLink link;
  link.halt = 13;
  link.halt_right = -0.2;
  path.links = {link};
  EXPECT_NEAR(walking_place(here_.view(), path, around_, own), -0.2, 1e-9);
  path.links[0].halt = 23;
  EXPECT_NEAR(walking_place(here_.view(), path, around_, own), -0.2, 1e-9) << "on its way there";
  path.links[0].halt = 33;
  EXPECT_NEAR(walking_place(here_.view(), path, around_, own), -0.6, 1e-9) << "not yet";
  path.links[0].halt = 9.5;
  EXPECT_NEAR(walking_place(here_.view(), path, around_, own), -0.6, 1e-9) << "past it";
}

TEST_F(WalkingPlaceTest, WhoFollowsKeepsADistanceThatGrowsWithItsSpeed) {
  const std::size_t own = walker(10, 0, 1.3);
  const std::size_t ahead = walker(11, 0, 0.8);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Leader);
  EXPECT_EQ(here_.context(own).foe, here_.scene.id[ahead].value);
  EXPECT_NEAR(here_.context(own).allowed_speed, (1.0 - 0.4) / 0.5, 1e-6);
  here_.move(ahead, 10.6);
  here_.update();
  EXPECT_NEAR(here_.context(own).allowed_speed, (0.6 - 0.4) / 0.5, 1e-6);
  // nor does anybody follow who is beside it or comes towards it
  here_.move(ahead, 10.6, 0.6);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::None);
  here_.move(ahead, 10.6);
  here_.scene.heading[ahead] = kPi;
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::None);
}

// a person crept up to a bicycle that stood across the sidewalk and never got past: the place that
// it chose was too near to that to get there, and held up it turned to the other side
TEST_F(WalkingPlaceTest, WhoComesUpToABicycleThatStandsInTheWayWalksRoundIt) {
  for (const double across : {-0.6, -0.4}) {  // 1.25 and 1.05 m are left
    here_ = RoadScene(sidewalk());
    const std::size_t own = walker(10, 0, 1.3);
    put_across("bicycle", box_footprint(1.7, 0.65), 15, across);
    double time = 0;
    for (; time < 20 && here_.scene.position[own].x() < 17; time += 0.05) walk(own);
    EXPECT_LT(time, 7.0) << across;
  }
}

// nor does who has waited for something else, a light or a gap, while its way leads past what
// stands
TEST_F(WalkingPlaceTest, WhoHasRoomBesideAVehicleStaysOnTheSidewalk) {
  const std::size_t own = walker(10, 0, 0.2);
  put_across("bicycle", box_footprint(1.7, 0.65), 14, 0.5);
  here_.traffic.waiting_time[own] = 50;
  EXPECT_LT(place_of(own), -0.6);
  EXPECT_GE(place_of(own), -1.5 + 0.25 + 0.1 - 1e-9);
}

// the way round a car whose tail stood over a crossing led off it by 80 cm: the place was chosen,
// and the sub-goal stayed on the crossing, before the tail
TEST_F(WalkingPlaceTest, WhoFindsAVehicleAcrossAllOfItsWayStepsOffItAfterAWhile) {
  const std::size_t own = walker(10, 0, 1.3);
  put_across("car", box_footprint(4.5, 1.8), 14, 0.5);
  const Vec2& place = here_.scene.position[own];
  double time = 0, farthest = 0;
  auto walk_to = [&](double x, double until) {
    for (; time < until && place.x() < x; time += 0.05) {
      walk(own);
      count_waiting(TrafficParameters{}, 0.05, Kinematics::Holonomic, here_.scene, here_.traffic,
                    own);
      farthest = std::min(farthest, place.y());
    }
  };
  walk_to(17, 4);
  EXPECT_GT(farthest, -1.5) << "on the sidewalk at first";
  walk_to(17, 30);
  EXPECT_LT(time, 20.0);
  EXPECT_LT(farthest, -1.9);
  EXPECT_GT(farthest, -3.0);
  walk_to(25, 30);
  EXPECT_GT(place.y(), -1.5) << "and is back on it";
}

}  // namespace
}  // namespace sumogamma
