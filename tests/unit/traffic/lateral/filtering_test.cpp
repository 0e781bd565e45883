// Narrow vehicles between queues: places, speeds, and who is first.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/locate.h"
#include "support/lane_looks.h"
#include "support/road_scene.h"
#include "support/small_net.h"
#include "traffic/lateral/lane_choice.h"
#include "traffic/lateral/passing.h"
#include "traffic/longitudinal/leader.h"

namespace sumogamma {
namespace {

using testing::let_all_look;
using testing::PlainNet;
using testing::RoadScene;
using testing::two_lanes;

TEST(FilteringSpeed, IsTheLessTheCloserTheSidesAre) {
  EXPECT_EQ(filtering_speed(TrafficParameters{}, 0.1), 0.0);
  EXPECT_GT(filtering_speed(TrafficParameters{}, 0.3), 2.0);
  EXPECT_LT(filtering_speed(TrafficParameters{}, 0.3), filtering_speed(TrafficParameters{}, 0.4));
}

TEST(PassingSpeed, LeavesTheWayThatTurningOutTakes) {
  const AgentTypeTable types = default_agent_types();
  const AgentType& motorcycle = type_of(types, find_agent_type(types, "motorcycle"));
  // behind a car that stands, 1.5 m to go aside: slower the nearer, and a slow walk in the end
  Passed passed{20.0, -1.2, 0.35, 0.0, 0.0, false, filtering_manner({})};
  double before = passing_speed(TrafficParameters{}, passed, motorcycle);
  for (const double gap : {10.0, 5.0, 2.0, 0.5}) {
    passed.gap = gap;
    EXPECT_LE(passing_speed(TrafficParameters{}, passed, motorcycle), before);
    before = passing_speed(TrafficParameters{}, passed, motorcycle);
  }
  EXPECT_GT(before, 0.0);
  EXPECT_LT(before, 0.5);
  // nobody creeps up to the car while the place beside it is taken
  passed.taken = true;
  EXPECT_EQ(passing_speed(TrafficParameters{}, passed, motorcycle), 0.0);
  // clear of it already: as fast as its sides allow
  passed.taken = false;
  passed.now = 0.35;
  EXPECT_GE(passing_speed(TrafficParameters{}, passed, motorcycle),
            filtering_speed(TrafficParameters{}, 0.35));
}

// A junction has room beside its lanes, for whoever has to get past: nobody rides there for liking.
TEST(PassingOffset, NobodyLikesToRideBesideTheLanesOfAJunction) {
  RoadScene here{testing::small_net()};
  const std::size_t own = here.add("bicycle", {"in", "out"}, 100, 4);
  here.scene.manners[own].path_offset = -2.0;
  here.update();
  const PathStretch& stretch = here.path(own).stretch_at(100);
  ASSERT_GT(stretch.room_right, 2.8);
  Surroundings around;
  look_around(here.view(), own, 60.0, 8.0, around);
  const double place = passing_offset(here.view(), here.path(own), around, own);
  EXPECT_NEAR(place, -(1.6 - around.half_width - here.parameters.tight_side), 1e-9);
}

// a bicycle whose path began with a change of lanes had begun it before it first looked
TEST(ChooseLanes, WhoHasJustComeLooksAtOnce) {
  PlainNet net = two_lanes();
  net.nodes += "<node id='X' x='300' y='0'/>";
  net.edges += "<edge id='on' from='E' to='X' numLanes='1' speed='13.89' width='3.5'/>";
  net.connections = "<connection from='WE' to='on' fromLane='1' toLane='0'/>";
  RoadScene here{testing::read_plain_net(net)};
  const std::size_t own = here.add("bicycle", {"WE", "on"}, 5, 4, 0, -1, "WE_0");
  const LaneId wanted = here.model.road.lane_by_name.at("WE_1");
  LaneChoiceWork work;
  Workers alone(1);
  for (const bool known : {true, false}) {
    here.scene.context[own].active = known;
    here.scene.tick = 1;  // not its own
    choose_lanes(here.tick(alone), work);
    EXPECT_EQ(here.traffic.merge_to[own], known ? kNoLane : wanted);
  }
}

// two queues of cars that stand on lanes of 3.5 m; a motorcycle comes behind the right one
class Filtering : public ::testing::Test {
 protected:
  Filtering() {
    for (const char* lane : {"WE_0", "WE_1"})
      for (const double along : {80.0, 86.5, 93.0}) here_.add("car", {"WE"}, along, 0, 0, -1, lane);
    rider_ = here_.add("motorcycle", {"WE"}, 66, 5, 0, -1, "WE_0");
  }
  double place() {
    here_.update();
    Surroundings around;
    look_around(here_.view(), rider_, 60.0, 8.0, around);
    return passing_offset(here_.view(), here_.path(rider_), around, rider_);
  }
  RoadScene here_{testing::read_plain_net(two_lanes())};
  std::size_t rider_ = 0;
};

TEST_F(Filtering, AimsAtTheMiddleBetweenTheQueues) { EXPECT_NEAR(place(), 1.75, 1e-6); }

// a motorcycle that braked behind a car swerved before a truck that came from behind, 6 m/s faster
TEST_F(Filtering, NobodyMovesOverBeforeWhoComesFromBehind) {
  const std::size_t other = here_.add("motorcycle", {"WE"}, 60, 5, 0, -1, "WE_0");
  here_.move(other, 61, 1.75);
  EXPECT_NEAR(place(), 1.75, 1e-6) << "who is as slow follows";
  here_.set_speed(other, 12);
  EXPECT_LT(place(), 0.5);
}

// who looked 8 s ahead saw nothing in the gap until it stood too close behind a car to turn out
TEST_F(Filtering, ChoosesTheGapWhileItIsStillFarAway) {
  here_.move(rider_, 52);
  EXPECT_NEAR(place(), 1.75, 1e-6);
}

TEST_F(Filtering, FollowsNobodyWhomItMeansToPassAndGetsSlowBeforeThem) {
  here_.traffic.passing_offset[rider_] = here_.traffic.lateral_aim[rider_] = place();
  DrivingAhead ahead;
  const Leader leader = find_leader(here_.view(), rider_, 60.0, ahead);
  EXPECT_EQ(leader.id, -1);
  EXPECT_GE(ahead.passed, 0);
  EXPECT_LT(ahead.passing_speed, 6.0);
}

TEST_F(Filtering, WhoIsAheadOnTheWayIntoTheGapGoesFirst) {
  const std::size_t other = here_.add("motorcycle", {"WE"}, 31.5, 5, 0, -1, "WE_1");
  here_.move(rider_, 30, 0.5);
  here_.move(other, 31.5, -1.75);
  here_.update();
  for (const std::size_t row : {rider_, other})
    here_.traffic.lateral_aim[row] = row == rider_ ? 1.75 : -1.75;
  const auto cap = [&](std::size_t row) {
    DrivingAhead ahead;
    find_leader(here_.view(), row, 60.0, ahead);
    return std::pair(ahead.passing_speed, ahead.passed);
  };
  EXPECT_EQ(cap(rider_).second, static_cast<std::int64_t>(here_.scene.id[other].value));
  EXPECT_NE(cap(other).second, static_cast<std::int64_t>(here_.scene.id[rider_].value));
}

// the gap was free, and eight motorcycles stood behind one that had halted beside it, amid its
// change
TEST_F(Filtering, WhoStandsAmidItsLaneChangeIsPassed) {
  const std::size_t other = here_.add("motorcycle", {"WE"}, 65, 1, 0, -1, "WE_1");
  const LaneId lane = here_.model.road.lane_by_name.at("WE_0");
  auto changing = change_lane(here_.replan(other), lane, 12.0);
  ASSERT_TRUE(changing);
  change_path(std::move(changing->path), changing->along, other, here_.road, here_.scene,
              here_.traffic);
  here_.scene.position[other] = here_.scene.position[rider_] + Vec2(4.0, -1.0);
  here_.move(rider_, here_.scene.path_along[rider_], 1.75);
  here_.traffic.lateral_aim[rider_] = 1.75;
  here_.update();
  ASSERT_TRUE(here_.path(other).stretch_at(here_.scene.path_along[other]).changing);
  here_.traffic.merge_to[other] = lane;
  const auto lets_in = [&] {
    DrivingAhead ahead;
    find_leader(here_.view(), rider_, 60.0, ahead);
    return ahead.merging.id;
  };
  EXPECT_EQ(lets_in(), static_cast<std::int64_t>(here_.scene.id[other].value));
  here_.scene.held[other].standing = 5;
  EXPECT_EQ(lets_in(), -1);
}

// a car stood through a green behind the tail of one that had changed into the full lane beside
class TailInTheLane : public ::testing::Test {
 protected:
  TailInTheLane() {
    other_ = here_.add("car", {"WE"}, 100, 0, 0, -1, "WE_1");
    own_ = here_.add("car", {"WE"}, 85, 3, 0, -1, "WE_0");
    stand(1.1);
  }
  /// The one ahead stands so far towards the own lane [m], its nose away from it.
  void stand(double aside) {
    here_.move(other_, 100, -aside);
    here_.scene.heading[other_] = 0.3;
  }
  double place() {
    here_.update();
    Surroundings around;
    look_around(here_.view(), own_, 60.0, 8.0, around);
    return passing_offset(here_.view(), here_.path(own_), around, own_);
  }
  std::int64_t leader() {
    here_.traffic.passing_offset[own_] = here_.traffic.lateral_aim[own_] = place();
    DrivingAhead ahead;
    return find_leader(here_.view(), own_, 60.0, ahead).id;
  }
  RoadScene here_{testing::read_plain_net(two_lanes())};
  std::size_t own_ = 0, other_ = 0;
};

TEST_F(TailInTheLane, IsPassedWithinTheLane) {
  EXPECT_LT(place(), -0.2);
  EXPECT_GE(place(), -(1.75 - 0.9 - 0.15) - 1e-9);
  EXPECT_EQ(leader(), -1);
}

TEST_F(TailInTheLane, IsWaitedForWhereThereIsNoRoom) {
  stand(1.6);
  EXPECT_EQ(leader(), static_cast<std::int64_t>(here_.scene.id[other_].value));
}

TEST_F(TailInTheLane, IsWaitedForWhileItMovesOrWantsToComeIn) {
  here_.traffic.merge_to[other_] = here_.model.road.lane_by_name.at("WE_0");
  EXPECT_NEAR(place(), 0.0, 0.2);
  here_.traffic.merge_to[other_] = kNoLane;
  here_.set_speed(other_, 2.0);
  EXPECT_NEAR(place(), 0.0, 0.2);
}

// two buses abreast locked when the one meant to pass the other that was amid its change
TEST_F(TailInTheLane, IsWaitedForWhileItIsOnItsWayIn) {
  const LaneId own = here_.model.road.lane_by_name.at("WE_0");
  here_.update();
  EXPECT_TRUE(stands_beside_lane(here_.view(), other_, own, 2.4));
  here_.scene.lane[other_].lane = own;
  EXPECT_FALSE(stands_beside_lane(here_.view(), other_, own, 2.4));
}

// who filtered to the left of a bus and then turned right, across its way, was pressed against it
TEST(FilteringBeforeAJunction, IsOnTheSideOfTheTurn) {
  const RoadNetwork network = testing::read_plain_net(testing::crossroads("priority"));
  auto place = [&](const std::string& to) {
    RoadScene here(network);
    const double line = here.path(here.add("car", {"WC", "CE"}, 0, 0)).links.front().stop_line;
    here.move(0, 20.0);
    for (const char* lane : {"WC_0", "WC_1"})
      for (const double before : {4.0, 11.0})
        here.add("car", {"WC", "CE"}, line - before, 0, 0, -1, lane);
    const std::size_t rider = here.add("motorcycle", {"WC", to}, line - 22.0, 5, 0, -1, "WC_0");
    here.update();
    Surroundings around;
    look_around(here.view(), rider, 60.0, 8.0, around);
    return passing_offset(here.view(), here.path(rider), around, rider);
  };
  EXPECT_NEAR(place("CE"), 1.6, 0.2) << "straight on: between the queues";
  EXPECT_LT(place("CS"), 1.3) << "to the right: within its lane";
}

// one that rode on the right of a car over a junction and turned left right behind that came out on
// the sidewalk
TEST(FilteringBeforeAJunction, IsOnTheSideOfATurnCloseBehindIt) {
  PlainNet net;
  net.nodes =
      "<node id='W' x='0' y='0'/><node id='M' x='200' y='0'/><node id='C' x='215' y='0'/>"
      "<node id='N' x='215' y='150'/><node id='E' x='400' y='0'/><node id='S' x='200' y='-100'/>";
  net.edges =
      "<edge id='WM' from='W' to='M' numLanes='2' speed='13.89'/>"
      "<edge id='MC' from='M' to='C' numLanes='2' speed='13.89'/>"
      "<edge id='CE' from='C' to='E' numLanes='2' speed='13.89'/>"
      "<edge id='CN' from='C' to='N' numLanes='2' speed='13.89'/>"
      "<edge id='SM' from='S' to='M' numLanes='1' speed='13.89'/>";
  const RoadNetwork network = testing::read_plain_net(net);
  auto place = [&](const std::string& to) {
    RoadScene here(network);
    for (const char* lane : {"WM_0", "WM_1"})
      for (const double before : {6.0, 12.5})
        here.add("car", {"WM", "MC", "CE"}, 197.0 - before, 0, 0, -1, lane);
    const std::size_t rider = here.add("motorcycle", {"WM", "MC", to}, 175.0, 5, 0, -1, "WM_1");
    here.update();
    Surroundings around;
    look_around(here.view(), rider, 60.0, 8.0, around);
    return passing_offset(here.view(), here.path(rider), around, rider);
  };
  EXPECT_NEAR(place("CE"), -1.6, 0.2) << "straight on: between the queues";
  EXPECT_GT(place("CN"), -1.3) << "to the left: within its lane";
}

// who passed a bus as both turned into a road with one lane less came out over its middle
TEST(FilteringBeforeAJunction, IsWhereThereIsRoomBehindIt) {
  auto place = [&](int lanes_behind, double before) {
    PlainNet net;
    net.nodes =
        "<node id='W' x='0' y='0'/><node id='M' x='200' y='0'/><node id='E' x='400' y='0'/>";
    net.edges =
        "<edge id='WM' from='W' to='M' numLanes='2' speed='13.89' width='3.5'/>"
        "<edge id='ME' from='M' to='E' speed='13.89' width='3.5' numLanes='" +
        std::to_string(lanes_behind) + "'/>";
    RoadScene here{testing::read_plain_net(net)};
    for (const char* lane : {"WM_0", "WM_1"})
      for (const double gap : {6.0, 12.5})
        here.add("car", {"WM"}, 200.0 - before + gap, 0, 0, -1, lane);
    const std::size_t rider =
        here.add("motorcycle", {"WM", "ME"}, 200.0 - before, 5, 0, -1, "WM_0");
    here.update();
    Surroundings around;
    look_around(here.view(), rider, 60.0, 8.0, around);
    return std::abs(passing_offset(here.view(), here.path(rider), around, rider));
  };
  EXPECT_NEAR(place(2, 25.0), 1.75, 0.1) << "between the queues";
  EXPECT_LE(place(1, 25.0), 1.75 - 0.45 - 0.15 + 1e-9) << "within its lane";
  EXPECT_NEAR(place(1, 80.0), 1.75, 0.1) << "the junction is far away yet";
}

// who passed a queue at the kerb and then turned there went over the tip of the sidewalk
TEST(FilteringBeforeAJunction, IsOffTheKerbWhereACornerIsRounded) {
  PlainNet net;
  net.nodes = "<node id='W' x='0' y='0'/><node id='M' x='200' y='0'/>";
  net.edges = "<edge id='WM' from='W' to='M' numLanes='1' speed='13.89' width='3.5'/>";
  RoadScene here{testing::read_plain_net(net)};
  here.add("car", {"WM"}, 0, 0);
  auto path = std::make_shared<Path>(here.path(0));
  const AgentTypeId type = find_agent_type(here.model.types, "motorcycle");
  const std::size_t rider = here.add(type, path, 0, 3);
  auto place = [&](double along, double side, double cut = 0.75) {
    path->lane_middle = {{150, -cut * side}};  // nearer to that side than the lane's middle
    here.move(0, along + 5.0, -0.85 * side);
    here.move(rider, along);
    here.update();
    Surroundings around;
    look_around(here.view(), rider, 60.0, 8.0, around);
    return std::abs(passing_offset(here.view(), here.path(rider), around, rider));
  };
  constexpr double kKerb = -1.0;
  EXPECT_NEAR(place(120.0, kKerb), 1.1, 0.1) << "beside the car";
  EXPECT_LE(place(148.0, kKerb), 1.75 - 0.5 - 0.45 - 0.15 + 1e-9);
  EXPECT_NEAR(place(153.0, kKerb), 1.1, 0.1) << "past the corner";
  EXPECT_NEAR(place(148.0, kKerb, 0.2), 1.1, 0.1) << "a bend smoothed by as much as any is";
  EXPECT_NEAR(place(148.0, -kKerb), 1.1, 0.1) << "to the middle of the road there is no kerb";
}

// a motorcycle that rode straight on passed another on its left, which turned left there: both came
// to lie side by side, a hand's breadth in each other
TEST(FilteringBeforeAJunction, IsNotOnTheSideToWhichThePassedOneTurns) {
  const RoadNetwork network = testing::read_plain_net(testing::crossroads("priority"));
  auto place = [&](const std::string& to, double speed, double before) {
    RoadScene here(network);
    const std::size_t passed = here.add("motorcycle", {"WC", to}, 0, speed, 0, -1, "WC_1");
    const std::size_t rider = here.add("motorcycle", {"WC", "CE"}, 0, 9, 0, -1, "WC_1");
    const double line = here.path(passed).links.front().stop_line;
    here.move(passed, line - before, -0.8);
    here.move(rider, line - before - 14.0);
    here.update();
    Surroundings around;
    look_around(here.view(), rider, 60.0, 8.0, around);
    return passing_offset(here.view(), here.path(rider), around, rider);
  };
  EXPECT_GT(place("CE", 4.0, 8.0), 0.2) << "on the left of who goes straight on";
  EXPECT_LT(place("CN", 4.0, 8.0), 0.1) << "not of who turns left";
  EXPECT_GT(place("CN", 4.0, 30.0), 0.2) << "far from where it turns";
  EXPECT_GT(place("CN", 0.0, 8.0), 0.2) << "who stands in a queue is passed";
}

// one that filtered in the middle of the lane beside passed that lane's red light at its own green
TEST(FilteringBeforeAJunction, StaysOverTheEdgeOfItsLaneBeforeASignal) {
  auto place = [&](const char* junction) {
    const RoadNetwork network = testing::read_plain_net(testing::crossroads(junction));
    RoadScene here(network);
    const double line = here.path(here.add("car", {"WC", "CE"}, 0, 0)).links.front().stop_line;
    here.move(0, 20.0);
    here.add("car", {"WC", "CE"}, line - 4.0, 0, 0, -1, "WC_1");
    const std::size_t rider = here.add("motorcycle", {"WC", "CE"}, line - 14.0, 5, 0, -1, "WC_1");
    here.update();
    Surroundings around;
    look_around(here.view(), rider, 60.0, 8.0, around);
    return std::abs(passing_offset(here.view(), here.path(rider), around, rider));
  };
  const double lane_and_quarter = 1.6 + 0.25 * 0.9 + 1e-9;
  EXPECT_GT(place("priority"), lane_and_quarter);
  EXPECT_LE(place("traffic_light"), lane_and_quarter);
}

// one that came by a short road before the signal stood there before it could move over
TEST(FilteringBeforeAJunction, SeesTheSignalBehindTheNextJunction) {
  for (const char* type : {"priority", "traffic_light"}) {
    PlainNet net;
    net.nodes =
        "<node id='W' x='0' y='0'/><node id='M' x='200' y='0'/>"
        "<node id='N' x='225' y='100'/><node id='E' x='400' y='0'/><node id='C' x='225' y='0' "
        "type='" +
        std::string(type) + "'/>";
    net.edges =
        "<edge id='WM' from='W' to='M' numLanes='2' speed='13.89'/>"
        "<edge id='MC' from='M' to='C' numLanes='2' speed='13.89'/>"
        "<edge id='CE' from='C' to='E' numLanes='2' speed='13.89'/>"
        "<edge id='NC' from='N' to='C' numLanes='1' speed='13.89'/>";
    RoadScene here{testing::read_plain_net(net)};
    here.add("car", {"WM", "MC", "CE"}, 197, 0, 0, -1, "WM_1");
    const std::size_t rider = here.add("motorcycle", {"WM", "MC", "CE"}, 187, 5, 0, -1, "WM_1");
    here.update();
    Surroundings around;
    look_around(here.view(), rider, 60.0, 8.0, around);
    const double place = std::abs(passing_offset(here.view(), here.path(rider), around, rider));
    EXPECT_EQ(place > 1.6 + 0.25 * 0.9 + 1e-9, std::string(type) == "priority") << type;
  }
}

}  // namespace
}  // namespace sumogamma
