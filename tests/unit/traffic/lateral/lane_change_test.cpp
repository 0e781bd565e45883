// Lane changes: for speed, for the trip, and who lets whom in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scene/locate.h"
#include "support/lane_looks.h"
#include "support/road_scene.h"
#include "support/small_net.h"
#include "traffic/lateral/gap_acceptance.h"
#include "traffic/lateral/lane_choice.h"
#include "traffic/longitudinal/leader.h"

namespace sumogamma {
namespace {

using testing::let_all_look;
using testing::PlainNet;
using testing::RoadScene;
using testing::two_lanes;

/// Where a row's path changes lanes for the first time; null where it doesn't.
const PathStretch* first_change(RoadScene& here, std::size_t row) {
  const auto& stretches = here.path(row).stretches;
  const auto change = std::find_if(stretches.begin(), stretches.end(),
                                   [](const PathStretch& stretch) { return stretch.changing; });
  return change != stretches.end() ? &*change : nullptr;
}

// Somebody changes to the left lane, beside a car there that is a metre ahead.
class ChangingLanes : public ::testing::Test {
 protected:
  /// Of the type, where its path is so far from the middle of the left lane, and so far to the
  /// right of its path.
  void begin(const std::string& type, double from_lane, double to_right,
             const std::string& other = "car", double ahead = 1.0) {
    own_ = here_.add(type, {"WE"}, 66, 2, 0, -1, "WE_0");
    const LaneId left = here_.model.road.lane_by_name.at("WE_1");
    auto changed = change_lane(here_.replan(own_), left, 40);
    ASSERT_TRUE(changed);
    double along = changed->along;
    change_path(std::move(changed->path), along, own_, here_.road, here_.scene, here_.traffic);
    const Polyline& target = here_.model.road.lane(left).centerline;
    while (target.project(here_.path(own_).line.point_at(along)).distance > from_lane) along += 0.5;
    here_.move(own_, along, -to_right);
    const double beside = target.project(here_.scene.position[own_]).along;
    car_ = here_.add(other, {"WE"}, beside + ahead, 0, 0, -1, "WE_1");
  }
  /// Does it halt to let the car go first?
  bool halts() {
    here_.update();
    let_all_look(here_);
    return std::isfinite(here_.traffic.gate[own_]);
  }
  RoadScene here_{testing::read_plain_net(two_lanes())};
  std::size_t own_ = 0, car_ = 0;
};

// or both would wait for ever
TEST_F(ChangingLanes, NobodyLetsSomebodyGoFirstWhoWaitsForAGap) {
  begin("car", 1.6, 0.6);
  EXPECT_TRUE(halts());
  here_.scene.held[car_].standing = 5;
  here_.traffic.gate[car_] = here_.scene.path_along[car_];
  // its own look would tell it that it needs no gap
  here_.scene.control[car_] = Control::External;
  EXPECT_FALSE(halts());
}

// it had halted for the nose of a car that stood behind it for want of room, on 3 m of the Magic
// Roundabout, and both stood there until the end
TEST_F(ChangingLanes, NorWhoWaitsForItself) {
  begin("car", 1.6, 0.6);
  EXPECT_TRUE(halts());
  here_.scene.held[car_].standing = 5;
  EXPECT_TRUE(halts()) << "it may go any time";
  here_.scene.context[car_].foe = static_cast<std::int64_t>(here_.scene.id[own_].value);
  let_all_look(here_);
  EXPECT_FALSE(std::isfinite(here_.traffic.gate[own_]));
}

// a car turned in before a bus whose front was ahead already, and the two wedged each other
TEST_F(ChangingLanes, WhoHasItsNoseAheadGoesFirst) {
  begin("car", 1.6, 0.9, "bus", -2.5);
  EXPECT_TRUE(halts());
}
TEST_F(ChangingLanes, WhoIsAheadOfTheOthersNoseGoesOn) {
  begin("car", 1.6, 0.9, "bus", -5.0);
  EXPECT_FALSE(halts());
}

// it stood for 80 s amid its change beside a queue, its own lane empty before it
TEST_F(ChangingLanes, WhoHasToHaltAmidItGoesBackAndOn) {
  begin("car", 1.6, 0.6);
  EXPECT_TRUE(halts());
  here_.update();
  ASSERT_EQ(here_.context(own_).reason, LimitReason::Merge);
  const auto is_amid_change = [&] {
    return here_.path(own_).stretch_at(here_.scene.path_along[own_]).changing;
  };
  here_.scene.held[own_].standing = 3;
  let_all_look(here_);
  EXPECT_TRUE(is_amid_change());
  here_.scene.held[own_].standing = 6;
  let_all_look(here_);
  EXPECT_FALSE(is_amid_change());
}

// motorcycles halted beside every car of a queue, for minutes in all
TEST_F(ChangingLanes, WhoFiltersGoesOnBetweenTheLanes) {
  begin("motorcycle", 1.2, 0.3);
  EXPECT_FALSE(halts());
}

// who changed lanes before a lane ended pushed in before somebody whom it had to let in anyway
TEST(BetterLane, NobodyChangesForALaneThatRunsIntoItsOwn) {
  for (const bool one_lane_after : {false, true}) {
    PlainNet net;
    net.nodes =
        "<node id='W' x='0' y='0'/><node id='M' x='120' y='0' type='zipper'/>"
        "<node id='E' x='400' y='0'/>";
    net.edges =
        "<edge id='WM' from='W' to='M' numLanes='2' speed='13.89'/>"
        "<edge id='ME' from='M' to='E' numLanes='" +
        std::string(one_lane_after ? "1" : "2") + "' speed='13.89'/>";
    net.connections = one_lane_after ? "<connection from='WM' to='ME' fromLane='0' toLane='0'/>"
                                       "<connection from='WM' to='ME' fromLane='1' toLane='0'/>"
                                     : "";
    RoadScene here{testing::read_plain_net(net)};
    const std::size_t own = here.add("car", {"WM", "ME"}, 40, 8, 0, -1, "WM_0");
    here.add("bus", {"WM", "ME"}, 62, 3, 0, -1, "WM_0");
    here.update();
    const LaneId before = here.path(own).stretch_at(70).lane;
    let_all_look(here);
    EXPECT_EQ(here.path(own).stretch_at(70).lane == before, one_lane_after);
  }
}

/// Does a row's path come to a lane?
bool drives_on(const RoadScene& here, std::size_t row, const std::string& lane) {
  const auto& stretches = here.path(row).stretches;
  return std::any_of(stretches.begin(), stretches.end(), [&](const PathStretch& stretch) {
    return here.model.road.lane(stretch.lane).name == lane;
  });
}

/// Two lanes over 400 m, of which the left one alone leads on.
RoadNetwork left_lane_leads_on() {
  PlainNet net;
  net.nodes = "<node id='W' x='0' y='0'/><node id='M' x='400' y='0'/><node id='E' x='500' y='0'/>";
  net.edges =
      "<edge id='WM' from='W' to='M' numLanes='2' speed='13.89'/>"
      "<edge id='ME' from='M' to='E' numLanes='1' speed='13.89'/>";
  net.connections = "<connection from='WM' to='ME' fromLane='1' toLane='0'/>";
  return testing::read_plain_net(net);
}

// The way that a change takes at full speed was planned: in a queue vehicles stood over two lanes.
TEST(NeededChange, IsAsLongAsItsSpeedAsksFor) {
  RoadScene here{left_lane_leads_on()};
  const std::size_t own = here.add("car", {"WM", "ME"}, 19, 3, 0, -1, "WM_0");
  const PathStretch& planned = here.path(own).stretches.at(1);
  ASSERT_TRUE(planned.changing);
  ASSERT_GT(planned.to - planned.from, 40.0);
  here.update();
  let_all_look(here);
  const PathStretch* changed = first_change(here, own);
  ASSERT_NE(changed, nullptr);
  EXPECT_LT(changed->from, here.scene.path_along[own] + 1.0) << "it goes over now";
  EXPECT_LT(changed->to - changed->from, 15.0);
}

// it stood over two lanes through a green when it wanted back into the queue on its own
TEST(BetterLane, TheOneThatATurnNeedsIsKeptFrom150MetresOn) {
  const RoadNetwork network = left_lane_leads_on();
  for (const double before : {200.0, 120.0}) {
    RoadScene here{network};
    const std::size_t own = here.add("car", {"WM", "ME"}, 400.0 - before, 6, 0, -1, "WM_1");
    here.add("bus", {"WM", "ME"}, 422.0 - before, 2, 0, -1, "WM_1");
    here.update();
    let_all_look(here);
    EXPECT_EQ(drives_on(here, own, "WM_0"), before > 150.0) << before;
  }
}

// a bus swung round the one at its stop, and halted there askew, its nose over the kerb
TEST(BetterLane, NobodyPassesWhoIsAtItsOwnStop) {
  PlainNet net;
  net.nodes = "<node id='W' x='0' y='0'/><node id='E' x='800' y='0'/>";
  net.edges = "<edge id='WE' from='W' to='E' numLanes='2' speed='13.89'/>";
  const RoadNetwork network = testing::read_plain_net(net);
  for (const double stop : {145.0, 500.0}) {
    RoadScene here{network};
    const std::size_t own = here.add("bus", {"WE"}, 100, 6, 0, -1, "WE_0");
    here.add("bus", {"WE"}, 130, 2, 0, -1, "WE_0");
    Path path = here.path(own);
    path.stops = {{stop, 20.0, 15.0, 0}};
    take_path(std::move(path), 100, own, here.road, here.scene);
    here.scene.halt[own].next = 0;
    here.update();
    let_all_look(here);
    EXPECT_EQ(drives_on(here, own, "WE_1"), stop > 300.0) << stop;
  }
}

// they passed the queue to its head, stood there for their gap, and the other lane behind them
TEST(BetterLane, WhoPassesAQueueHasToGetBackIntoIt) {
  const RoadNetwork network = left_lane_leads_on();
  for (const double their_speed : {0.0, 8.0}) {
    RoadScene here{network};
    const std::size_t own = here.add("car", {"WM", "ME"}, 150, 6, 0, -1, "WM_1");
    here.add("bus", {"WM", "ME"}, 172, 3, 0, -1, "WM_1");
    for (double place = 260; place < 390; place += 8.0)
      here.add("car", {"WM", "ME"}, place, their_speed, 0, -1, "WM_1");
    here.update();
    let_all_look(here);
    EXPECT_EQ(drives_on(here, own, "WM_0"), their_speed > 5.0);
  }
}

// a queue before a light filled one of two lanes that both led on behind it for 85 m, the other was
// empty through its greens
TEST(BetterLane, WhoPassesAQueueAtALightGetsBackIntoItBehindThat) {
  for (const char* type : {"priority", "traffic_light"}) {
    PlainNet net;
    net.nodes = "<node id='A' x='0' y='0'/><node id='L' x='260' y='0' type='" + std::string(type) +
                "'/><node id='B' x='340' y='0'/><node id='C' x='500' y='0'/>"
                "<node id='N' x='260' y='100'/><node id='S' x='260' y='-100'/>";
    net.edges =
        "<edge id='AL' from='A' to='L' numLanes='2' speed='13.89' priority='3'/>"
        "<edge id='LB' from='L' to='B' numLanes='2' speed='13.89' priority='3'/>"
        "<edge id='BC' from='B' to='C' numLanes='1' speed='13.89' priority='3'/>"
        "<edge id='NL' from='N' to='L' numLanes='1' speed='13.89' priority='1'/>"
        "<edge id='LS' from='L' to='S' numLanes='1' speed='13.89' priority='1'/>";
    net.connections =
        "<connection from='AL' to='LB' fromLane='0' toLane='0'/>"
        "<connection from='AL' to='LB' fromLane='1' toLane='1'/>"
        "<connection from='NL' to='LS' fromLane='0' toLane='0'/>"
        "<connection from='LB' to='BC' fromLane='1' toLane='0'/>";
    RoadScene here{testing::read_plain_net(net)};
    const std::size_t own = here.add("car", {"AL", "LB", "BC"}, 120, 8, 0, -1, "AL_1");
    here.add("bus", {"AL", "LB", "BC"}, 142, 3, 0, -1, "AL_1");
    for (double place = 160; place < 245; place += 6.5)
      here.add("car", {"AL", "LB", "BC"}, place, 0, 0, -1, "AL_1");
    here.update();
    let_all_look(here);
    const PathStretch* change = first_change(here, own);
    const bool leaves = change != nullptr && here.model.road.lane(change->lane).name == "AL_0";
    EXPECT_EQ(leaves, std::string(type) == "traffic_light");
  }
}

/// A road of two lanes into a short one that has them as well, and then a road from its left lane
/// alone.
PlainNet both_lanes_lead_on(double length = 50) {
  PlainNet net;
  const std::string end = std::to_string(150 + length);
  net.nodes = "<node id='W' x='0' y='0'/><node id='C' x='150' y='0'/><node id='E' x='" + end +
              "' y='0'/><node id='L' x='" + end + "' y='80'/>";
  net.edges =
      "<edge id='WC' from='W' to='C' numLanes='2' speed='13.89'/>"
      "<edge id='CE' from='C' to='E' numLanes='2' speed='13.89'/>"
      "<edge id='EL' from='E' to='L' numLanes='1' speed='13.89'/>";
  net.connections =
      "<connection from='WC' to='CE' fromLane='0' toLane='0'/>"
      "<connection from='WC' to='CE' fromLane='1' toLane='1'/>"
      "<connection from='CE' to='EL' fromLane='1' toLane='0'/>";
  return net;
}

// it stood at the end of its lane for minutes, although that lane leads on as well
class NoGap : public ::testing::Test {
 protected:
  std::string lane_at(const Path& path, double x) {
    const double place = path.line.project(Vec2(x, 0)).along;
    return here_.model.road.lane(path.stretch_at(place).lane).name;
  }
  RoadScene here_{testing::read_plain_net(both_lanes_lead_on())};
};

TEST_F(NoGap, WhoseLaneLeadsOnKeepsIt) {
  const std::size_t own = here_.add("car", {"WC", "CE", "EL"}, 10, 5, 0, -1, "WC_0");
  ASSERT_EQ(lane_at(here_.path(own), 120), "WC_1");
  const auto kept = keep_lane(here_.replan(own), 2.0);
  ASSERT_TRUE(kept);
  EXPECT_NEAR((kept->path.line.point_at(kept->along) - here_.scene.position[own]).norm(), 0.0, 0.1);
  EXPECT_EQ(lane_at(kept->path, 120), "WC_0");
  EXPECT_EQ(lane_at(kept->path, 185), "CE_1") << "it changes on the next road";
  // not where that costs more than it may, or the lane doesn't lead on at all
  EXPECT_FALSE(keep_lane(here_.replan(own), 0.2));
  const std::size_t late = here_.add("car", {"CE", "EL"}, 10, 5, 0, -1, "CE_0");
  EXPECT_FALSE(keep_lane(here_.replan(late), 1e9));
}

// on Shi Men Er Lu it swung over the stop lines of others on a road of 20 cm
TEST(NoGapBeforeAShortRoad, WhoCouldNotChangeOnItDoesNotKeepItsLane) {
  RoadScene here{testing::read_plain_net(both_lanes_lead_on(8))};
  const std::size_t own = here.add("car", {"WC", "CE", "EL"}, 10, 5, 0, -1, "WC_0");
  EXPECT_FALSE(keep_lane(here.replan(own), 1e9));
}

TEST_F(NoGap, WhoHasNoRoomLeftToChangeGoesOnByItsLane) {
  const double end =
      here_.model.road.lane(here_.model.road.lane_by_name.at("WC_0")).centerline.length();
  const std::size_t own = here_.add("car", {"WC", "CE", "EL"}, 5, 0, 0, -1, "WC_0");
  const double along = here_.scene.path_along[own];
  // the change begins at the last place that leaves room for it, beside somebody who stands
  auto late = stay_in_lane(here_.replan(own), end - 15.0 - along);
  ASSERT_TRUE(late);
  change_path(std::move(late->path), late->along, own, here_.road, here_.scene, here_.traffic);
  here_.move(own, end - 15.0);
  here_.add("car", {"WC", "CE", "EL"}, end - 14.5, 0, 0, -1, "WC_1");
  here_.update();
  let_all_look(here_);
  EXPECT_EQ(lane_at(here_.path(own), end - 2.0), "WC_0");
  EXPECT_FALSE(std::isfinite(here_.traffic.gate[own]));
}

// side by side they came to the end of their lanes, and stood there for minutes
TEST(Swap, OfTwoAbreastWhoWantEachOthersLaneOneLetsTheOtherAhead) {
  RoadScene here(testing::read_plain_net(two_lanes()));
  const std::size_t right = here.add("car", {"WE"}, 60, 7, 0, -1, "WE_0");
  const std::size_t left = here.add("car", {"WE"}, 60.5, 7, 0, -1, "WE_1");
  const auto& lanes = here.model.road.lane_by_name;
  here.update(2);
  const double before = here.context(right).allowed_speed;
  here.traffic.merge_to[right] = lanes.at("WE_1");
  here.traffic.merge_to[left] = lanes.at("WE_0");
  here.update(2);
  EXPECT_LT(here.context(right).allowed_speed, before - 0.05);
  EXPECT_EQ(here.context(right).foe, static_cast<std::int64_t>(here.scene.id[left].value));
  EXPECT_NE(here.context(left).foe, static_cast<std::int64_t>(here.scene.id[right].value));
}

// who was ahead stood at the end of its lane for 360 s, since the other waited beside it
TEST(Swap, NobodyWaitsForWhoWaitsForItToGetOutOfTheWay) {
  RoadScene here(testing::read_plain_net(two_lanes()));
  const std::size_t right = here.add("car", {"WE"}, 60, 0, 0, -1, "WE_0");
  const std::size_t left = here.add("car", {"WE"}, 60.5, 0, 0, -1, "WE_1");
  here.move(left, 60.5, -0.4);
  const auto& lanes = here.model.road.lane_by_name;
  here.traffic.merge_to[right] = lanes.at("WE_1");
  here.traffic.merge_to[left] = lanes.at("WE_0");
  here.update(2);
  EXPECT_EQ(here.context(right).allowed_speed, 0.0);
  here.traffic.gate[left] = 62;
  here.scene.held[left].standing = 3;
  here.update(2);
  EXPECT_GT(here.context(right).allowed_speed, 0.3);
}

// a car changed over and back within the last 15 m of its lane, into a motorcycle behind it
TEST_F(NoGap, NobodyChangesWhoHasNoRoomLeftToChangeBackIn) {
  const LaneId other = here_.model.road.lane_by_name.at("CE_0");
  for (const double place : {5.0, 20.0}) {
    const std::size_t own = here_.add("car", {"CE", "EL"}, place, 5, 0, -1, "CE_1");
    const auto changed = change_lane(here_.replan(own), other, 12.0);
    EXPECT_EQ(changed.has_value(), place < 10.0) << place;
  }
}

TEST_F(NoGap, NarrowVehiclesChangeLanesInLess) {
  const LaneId lane = here_.model.road.lane_by_name.at("WC_0");
  const double end = here_.model.road.lane(lane).centerline.length();
  for (const double turning_radius : {1.7, 4.5}) {
    const std::vector<EdgeId> route = testing::route_of(here_.model.road, {"WC", "CE", "EL"});
    PathRequest request;
    request.route = route;
    request.vehicle_class = vehicle_class::kMotorcycle;
    request.start_lane = lane;
    request.cornering.turning_radius = turning_radius;
    std::string why;
    const auto path = build_driving_path(here_.model.road, request, why);
    ASSERT_TRUE(path) << why;
    const auto late = stay_in_lane({here_.model.road, *path, 5.0, 20.0}, end - 14.0);
    EXPECT_EQ(late.has_value(), turning_radius < 2.0);
  }
}

/// Puts off the lane change of a row as long as there is room for it, and the row a metre before
/// it. Where it begins [m along the path].
double wait_at_gate(RoadScene& here, std::size_t row) {
  for (double room = 40.0; room > 0.0; room -= 1.0) {
    auto late = stay_in_lane(here.replan(row), room);
    if (!late) continue;
    change_path(std::move(late->path), late->along, row, here.road, here.scene, here.traffic);
    break;
  }
  const PathStretch* change = first_change(here, row);
  if (change == nullptr) throw std::runtime_error("the row changes no lane");
  here.move(row, change->from - 1.0);
  return change->from;
}

/// Moves a row along its path to where x is this [m].
void move_to_x(RoadScene& here, std::size_t row, double x) {
  here.move(row, here.path(row).line.project(Vec2(x, here.scene.position[row].y())).along);
}

// A bus that has to change into the lane beside, at the end of its own, in a queue: whoever was
// beside its tail was neither before nor behind it, and it stood there for minutes.
class LongWait : public ::testing::Test {
 protected:
  LongWait() : bus_(here_.add("bus", {"CE", "EL"}, 0, 0, 0, -1, "CE_0")) {
    const double gate = wait_at_gate(here_, bus_);
    here_.traffic.gate[bus_] = gate;
    here_.traffic.merge_to[bus_] = here_.model.road.lane_by_name.at("CE_1");
    here_.scene.held[bus_].standing = 12;
  }
  /// A car in the lane beside whose nose is so far behind the one of the bus [m].
  std::size_t add_car(double behind, double speed) {
    const std::size_t car = here_.add("car", {"CE", "EL"}, 5, speed, 0, -1, "CE_1");
    const double nose = here_.scene.position[bus_].x() + 6.0 - behind;
    move_to_x(here_, car, nose - 2.25);
    return car;
  }
  bool lets_in(std::size_t car) {
    here_.update();
    DrivingAhead ahead;
    find_leader(here_.view(), car, 60.0, ahead);
    return ahead.merging.id == static_cast<std::int64_t>(here_.scene.id[bus_].value);
  }
  bool waits_on() {
    let_all_look(here_);
    return std::isfinite(here_.traffic.gate[bus_]);
  }
  RoadScene here_{testing::read_plain_net(both_lanes_lead_on())};
  std::size_t bus_ = 0;
};

TEST_F(LongWait, WhoIsBesideTheTailLetsTheNoseIn) {
  const std::size_t car = add_car(4.0, 1.0);
  EXPECT_TRUE(lets_in(car));
  EXPECT_EQ(here_.context(car).foe, static_cast<std::int64_t>(here_.scene.id[bus_].value));
  here_.scene.held[bus_].standing = 5;
  EXPECT_FALSE(lets_in(car)) << "it has just come";
  here_.scene.held[bus_].standing = 12;
  here_.scene.held[car].standing = 30;
  EXPECT_FALSE(lets_in(car)) << "there is an end to courtesy";
  here_.scene.held[car].standing = 0;
  here_.traffic.waiting_time[car] = 50;
  EXPECT_FALSE(lets_in(car)) << "nor does it begin anew with a step";
}
TEST_F(LongWait, WhoseNoseIsNearTheNoseGoesOn) { EXPECT_FALSE(lets_in(add_car(1.0, 1.0))); }

TEST_F(LongWait, IsOverOnceWhoIsBesideTheTailHolds) {
  const std::size_t car = add_car(3.0, 0.0);
  here_.update();
  here_.scene.context[car] = {};
  EXPECT_TRUE(waits_on()) << "nobody holds yet";
  ASSERT_TRUE(lets_in(car));
  EXPECT_LT(here_.context(car).allowed_speed, 0.3);
  EXPECT_FALSE(waits_on());
}

// in a queue that crept on nobody let it in over 180 m, since it never stood for long
TEST_F(LongWait, CreepingOnIsWaitingToo) {
  const std::size_t car = add_car(4.0, 1.0);
  here_.scene.held[bus_].standing = 0.0;
  const auto lets_it_in = [&](double waiting, double speed) {
    here_.traffic.waiting_time[bus_] = waiting;
    here_.set_speed(bus_, speed);
    return lets_in(car);
  };
  EXPECT_TRUE(lets_it_in(15.0, 1.0));
  EXPECT_FALSE(lets_it_in(5.0, 1.0)) << "not for long";
  EXPECT_FALSE(lets_it_in(15.0, 6.0)) << "it gets on";
}

// whom others had let in drove on beside the queue, past its gap
TEST_F(LongWait, WhoIsLetInStaysWhereTheGapIs) {
  const std::size_t car = add_car(4.0, 0.0);
  here_.add("car", {"CE", "EL"}, here_.scene.position[bus_].x() - 145.0, 0, 0, -1, "CE_1");
  here_.scene.held[bus_].standing = 0.0;
  here_.set_speed(bus_, 1.0);
  here_.update();
  for (const bool holds : {false, true}) {
    here_.scene.context[car].foe =
        holds ? static_cast<std::int64_t>(here_.scene.id[bus_].value) : -1;
    EXPECT_TRUE(waits_on());
    EXPECT_EQ(here_.traffic.gate[bus_] <= here_.scene.path_along[bus_], holds);
  }
}

// a motorcycle stood for 100 s at the far side of its lane while car after car of the lane that it
// needed drove past it, and the queue of its own stood behind it
TEST(LetIn, IsWhoIsNarrowAtTheFarSideOfItsLane) {
  RoadScene here{testing::read_plain_net(both_lanes_lead_on())};
  const std::size_t rider = here.add("motorcycle", {"CE", "EL"}, 0, 0, 0, -1, "CE_0");
  here.traffic.gate[rider] = wait_at_gate(here, rider);
  here.move(rider, here.traffic.gate[rider] - 1.0, -1.0);
  here.traffic.merge_to[rider] = here.model.road.lane_by_name.at("CE_1");
  here.scene.held[rider].standing = 12;
  const std::size_t car = here.add("car", {"CE", "EL"}, 5, 4.0, 0, -1, "CE_1");
  move_to_x(here, car, here.scene.position[rider].x() - 15.0);
  here.update();
  EXPECT_EQ(here.context(car).foe, static_cast<std::int64_t>(here.scene.id[rider].value));
  here.traffic.merge_to[rider] = kNoLane;
  here.update();
  EXPECT_EQ(here.context(car).foe, -1);
}

// it stood before the begin of its change, and by the time that it got there the gap was gone
TEST(LetIn, BeginsItsChangeThere) {
  for (const bool holds : {false, true}) {
    RoadScene here(testing::read_plain_net(both_lanes_lead_on()));
    const std::size_t bus = here.add("bus", {"CE", "EL"}, 0, 0, 0, -1, "CE_0");
    const PathStretch* change = first_change(here, bus);
    ASSERT_NE(change, nullptr);
    ASSERT_GT(change->to - change->from, 30.0) << "planned for full speed";
    here.move(bus, change->from - 5.0);
    const std::size_t car = here.add("car", {"CE", "EL"}, 5, 0, 0, -1, "CE_1");
    move_to_x(here, car, here.scene.position[bus].x() - 6.0 - 2.0 - 2.25);
    here.update();
    here.scene.context[car].foe = holds ? static_cast<std::int64_t>(here.scene.id[bus].value) : -1;
    let_all_look(here);
    EXPECT_EQ(here.path(bus).stretch_at(here.scene.path_along[bus] + 1.0).changing, holds);
  }
}

/// A road of three lanes, of which the middle one alone leads on.
PlainNet middle_lane_leads_on() {
  PlainNet net;
  net.nodes = "<node id='W' x='0' y='0'/><node id='M' x='120' y='0'/><node id='E' x='200' y='0'/>";
  net.edges =
      "<edge id='WM' from='W' to='M' numLanes='3' speed='13.89'/>"
      "<edge id='ME' from='M' to='E' numLanes='1' speed='13.89'/>";
  net.connections = "<connection from='WM' to='ME' fromLane='1' toLane='0'/>";
  return net;
}

// From the right lane of three into the middle one.
class IntoTheMiddle : public ::testing::Test {
 protected:
  std::size_t add(const std::string& type, const std::string& lane) {
    const std::size_t row = here_.add(type, {"WM", "ME"}, 0, 0, 60, -1, lane);
    wait_at_gate(here_, row);
    return row;
  }
  bool waits(std::size_t row) {
    here_.update();
    let_all_look(here_);
    return std::isfinite(here_.traffic.gate[row]);
  }
  RoadScene here_{testing::read_plain_net(middle_lane_leads_on())};
};

// one held amid its change for the other, which took it for somebody about to go: a whole green
// long
TEST_F(IntoTheMiddle, WhoHasHaltedOnTheOtherSideDoesNotContestIt) {
  const std::size_t other = add("car", "WM_2"), own = add("car", "WM_0");
  move_to_x(here_, other, here_.scene.position[own].x() - 1.0);
  EXPECT_TRUE(waits(own));
  here_.scene.held[other].standing = 3.0;
  EXPECT_FALSE(waits(own));
}
TEST_F(IntoTheMiddle, NorDoesWhoLetsItGoFirst) {
  const std::size_t other = add("car", "WM_2"), own = add("car", "WM_0");
  move_to_x(here_, other, here_.scene.position[own].x() - 1.0);
  here_.update();
  here_.scene.context[other].foe = static_cast<std::int64_t>(here_.scene.id[own].value);
  let_all_look(here_);
  EXPECT_FALSE(std::isfinite(here_.traffic.gate[own]));
}

// where its path moves over already, somebody two lanes further on counted as in the next one
class TwoLanesAside : public IntoTheMiddle, public ::testing::WithParamInterface<int> {};
TEST_P(TwoLanesAside, IsNotInTheWay) {
  const std::size_t own = add("bus", "WM_0");
  const std::size_t other = here_.add("bus", {"WM"}, 60, 0, 0, -1, "WM_2");
  move_to_x(here_, other, here_.scene.position[own].x() + GetParam());
  EXPECT_FALSE(waits(own));
}
INSTANTIATE_TEST_SUITE_P(Ahead, TwoLanesAside, ::testing::Range(-2, 8));

TEST_F(IntoTheMiddle, WhomItsPathComesUpToOnlyThereIsFollowed) {
  const std::size_t own = add("car", "WM_0");
  here_.set_speed(own, 6.0);
  const std::size_t other = here_.add("car", {"WM", "ME"}, 60, 0, 0, -1, "WM_1");
  const PathStretch* change = first_change(here_, own);
  ASSERT_NE(change, nullptr);
  move_to_x(here_, other, here_.path(own).line.point_at(change->to + 1.0).x());
  EXPECT_FALSE(waits(own));
  move_to_x(here_, other, here_.path(own).line.point_at(change->to - 3.0).x());
  EXPECT_TRUE(waits(own));
}

// the one stood 4 cm too far ahead for the other, and neither went
TEST_F(LongWait, IsOverAlsoWhereWhoHoldsHasRolledOnByAHandsBreadth) {
  const std::size_t car = add_car(2.95, 0.0);
  here_.update();
  here_.scene.context[car].foe = static_cast<std::int64_t>(here_.scene.id[bus_].value);
  EXPECT_FALSE(waits_on());
}

// a car had halted 20 cm behind the tail to let a truck in: too near for a gap, and neither went
TEST_F(LongWait, IsOverOnceWhoIsRightBehindTheTailHolds) {
  const std::size_t car = add_car(12.2, 0.0);
  here_.update();
  here_.scene.context[car].foe = -1;
  EXPECT_TRUE(waits_on()) << "it may drive on";
  here_.scene.context[car].foe = static_cast<std::int64_t>(here_.scene.id[bus_].value);
  EXPECT_FALSE(waits_on());
}

// it stood for two minutes before its gate beside a lane that was free now and again, since the one
// behind it in its own lane, on its way over, too, waited for it
TEST_F(LongWait, WhoFollowsInItsOwnLaneLetsNobodyIn) {
  const std::size_t beside = add_car(4.0, 0.0);
  const std::size_t follower = here_.add("car", {"CE", "EL"}, 5, 0, 0, -1, "CE_0");
  here_.scene.position[follower] = here_.scene.position[bus_] + Vec2(-9.75, 1.3);
  here_.update();
  here_.scene.context[beside].foe = -1;
  here_.scene.context[follower].foe = static_cast<std::int64_t>(here_.scene.id[bus_].value);
  EXPECT_TRUE(waits_on());
  EXPECT_GT(here_.traffic.gate[bus_], here_.scene.path_along[bus_]);
}

// of two motorcycles abreast that wanted each other's lane one rolled back, and the other stayed
TEST(Swap, WhoHasRolledBackToLetOthersGoLeavesTheWayForANose) {
  RoadScene here(testing::read_plain_net(both_lanes_lead_on()));
  const std::size_t own = here.add("motorcycle", {"CE", "EL"}, 0, 0, 0, -1, "CE_0");
  wait_at_gate(here, own);
  const double x = here.scene.position[own].x();
  const std::size_t other = here.add("motorcycle", {"CE", "EL"}, 5, 0, 0, -1, "CE_1");
  const auto waits = [&](double behind, double gives_way) {
    move_to_x(here, other, x - behind);
    here.traffic.gives_way_left[other] = gives_way;
    here.update();
    let_all_look(here);
    return std::isfinite(here.traffic.gate[own]);
  };
  EXPECT_TRUE(waits(1.6, 0.0));
  EXPECT_TRUE(waits(0.6, 5.0)) << "its nose is beside the own one";
  EXPECT_FALSE(waits(1.6, 5.0));
}

// the lane was two metres long: everybody was on the junction before it, and nobody let anybody in
TEST_F(LongWait, WhoIsOnItsWayIntoThatLaneLetsItIn) {
  const std::size_t car = here_.add("car", {"WC", "CE", "EL"}, 100, 4, 0, -1, "WC_1");
  here_.move(car, here_.path(car).links.front().stop_line - 4.0);
  here_.move(bus_, 8.0);
  EXPECT_TRUE(lets_in(car));
  const std::size_t other = here_.add("car", {"WC"}, 140, 4, 0, -1, "WC_1");
  EXPECT_FALSE(lets_in(other)) << "it doesn't get there";
}

// a truck came out of the junction at 12 m/s and saw the car before it when that was in its lane
TEST(LetIn, IsWhoIsAmidItsChangeRightBehindAJunction) {
  RoadScene here{testing::read_plain_net(both_lanes_lead_on())};
  const std::size_t changing = here.add("car", {"CE", "EL"}, 0, 2, 0, -1, "CE_0");
  here.move(changing, wait_at_gate(here, changing) + 0.5);
  here.traffic.merge_to[changing] = here.model.road.lane_by_name.at("CE_1");
  const std::size_t car = here.add("car", {"WC", "CE", "EL"}, 100, 12, 0, -1, "WC_1");
  here.move(car, here.path(car).links.front().stop_line - 4.0);
  const auto lets_in = [&] {
    here.update();
    return here.context(car).foe == static_cast<std::int64_t>(here.scene.id[changing].value);
  };
  EXPECT_TRUE(lets_in());
  here.traffic.gate[changing] = here.scene.path_along[changing];
  EXPECT_FALSE(lets_in()) << "it has halted to let others past";
}

// SUMO put a motorcycle with 26 m/s behind a car that had begun to change into that lane
TEST(BetterLane, IsSaidAsSoonAsItIsChosen) {
  RoadScene here{testing::read_plain_net(two_lanes())};
  const std::size_t own = here.add("car", {"WE"}, 40, 10, 0, -1, "WE_0");
  here.add("bus", {"WE"}, 65, 3, 0, -1, "WE_0");
  here.update();
  EXPECT_EQ(here.traffic.merge_to[own], kNoLane);
  let_all_look(here);
  ASSERT_NE(first_change(here, own), nullptr);
  EXPECT_EQ(here.traffic.merge_to[own], here.model.road.lane_by_name.at("WE_1"));
}

// it looked 30 m back before it moved off
TEST(NoGapOnAFastRoad, IsWhereSomebodyComesFromFarBehind) {
  PlainNet net = both_lanes_lead_on(150);
  for (std::size_t at = 0; (at = net.edges.find("13.89", at)) != std::string::npos;)
    net.edges.replace(at, 5, "27.78");
  for (const double speed : {5.0, 25.0}) {
    RoadScene here(testing::read_plain_net(net));
    const std::size_t own = here.add("car", {"CE", "EL"}, 0, 0, 0, -1, "CE_0");
    wait_at_gate(here, own);
    const std::size_t other = here.add("car", {"CE", "EL"}, 5, speed, 0, -1, "CE_1");
    move_to_x(here, other, here.scene.position[own].x() - 60.0);
    here.update();
    let_all_look(here);
    const PathStretch* change = first_change(here, own);
    ASSERT_NE(change, nullptr);
    EXPECT_EQ(change->from > here.scene.path_along[own] + 5.0, speed > 20.0) << speed;
  }
}

// after one change to the left, before another: beside the path behind, still in the first lane,
// whoever came in the third seemed to be a lane further on, and who followed in the second in it
TEST(NoGapOnAFastRoad, IsWhereSomebodyComesBesideTheLaneOfBefore) {
  PlainNet net;
  net.nodes = "<node id='W' x='0' y='0'/><node id='M' x='300' y='0'/><node id='E' x='400' y='0'/>";
  net.edges =
      "<edge id='WM' from='W' to='M' numLanes='3' speed='27.78'/>"
      "<edge id='ME' from='M' to='E' numLanes='1' speed='27.78'/>";
  net.connections = "<connection from='WM' to='ME' fromLane='2' toLane='0'/>";
  const RoadNetwork network = testing::read_plain_net(net);
  for (const double speed : {5.0, 25.0}) {
    RoadScene here(network);
    const std::size_t own = here.add("car", {"WM", "ME"}, 0, 5, 0, -1, "WM_0");
    const LaneId middle = network.lane_by_name.at("WM_1");
    const auto& stretches = here.path(own).stretches;
    const auto first = std::find_if(stretches.begin(), stretches.end(), [&](const auto& stretch) {
      return stretch.changing && stretch.lane == middle;
    });
    ASSERT_NE(first, stretches.end());
    here.move(own, first->to - 0.5);
    const std::size_t other = here.add("car", {"WM", "ME"}, 5, speed, 0, -1, "WM_2");
    move_to_x(here, other, here.scene.position[own].x() - 45.0);
    here.update();
    Surroundings around;
    look_around(here.view(), own, 80.0, 8.0, around);
    const Lane& wanted = network.lane(network.lane_by_name.at("WM_2"));
    EXPECT_EQ(is_gap(here.view(), around, own, {.shift = 3.2, .middle = &wanted.centerline}, 1.5),
              speed < 20.0)
        << speed;
  }
}

// a motorcycle changed lanes 2 m before another that came from behind between the two lanes
TEST(NoGapBetweenLanes, IsWhereSomebodyComesFromBehindBetweenTheLanes) {
  const RoadNetwork network = testing::read_plain_net(both_lanes_lead_on());
  struct Case {
    double behind, speed, offset;
    bool gap;
  };
  for (const auto& [behind, speed, offset, gap] :
       {Case{6, 10, 1.6, false}, Case{6, 3, 1.6, true}, Case{60, 10, 1.6, true},
        Case{6, 10, -1.6, true}, Case{6, 10, 0.2, true}}) {
    RoadScene here(network);
    const std::size_t own = here.add("motorcycle", {"CE"}, 30, 4, 0, -1, "CE_0");
    const std::size_t other = here.add("motorcycle", {"CE"}, 0, speed, 0, -1, "CE_0");
    here.move(other, here.scene.path_along[own] - behind, offset);
    here.update();
    Surroundings around;
    look_around(here.view(), own, 80.0, 8.0, around);
    const Lane& wanted = network.lane(network.lane_by_name.at("CE_1"));
    EXPECT_EQ(is_gap(here.view(), around, own, {.shift = 3.2, .middle = &wanted.centerline}, 3.0),
              gap)
        << behind << " m behind, " << speed << " m/s, " << offset << " m to the left";
  }
}

// somebody who stood behind the begin of its path counted as beside it, and it waited for ever;
// further back nobody was seen
TEST(Surrounding, WhoIsBehindTheBeginOfAPathIsSeenWhereItIs) {
  RoadScene here(testing::read_plain_net(both_lanes_lead_on()));
  const std::size_t own = here.add("car", {"CE", "EL"}, 5, 0, 0, -1, "CE_0");
  const std::size_t behind = here.add("car", {"WC", "CE", "EL"}, 0, 0, 0, -1, "WC_0");
  for (const double before_line : {1.0, 25.0}) {
    here.move(behind, here.path(behind).links.front().stop_line - before_line);
    here.update();
    Surroundings around;
    look_around(here.view(), own, 60.0, 8.0, around);
    const Vec2 way = here.scene.position[behind] - here.scene.position[own];
    ASSERT_LT(here.scene.path_along[own] + way.x(), -0.5) << "behind its begin";
    ASSERT_EQ(around.users.size(), 1u) << before_line;
    const PathUser& user = around.users.front();
    EXPECT_NEAR(user.offset, way.y(), 0.05);
    EXPECT_NEAR(0.5 * (user.front + user.rear), around.along + way.x(), 0.05);
  }
}

// who rolled over it by a hair had begun its change, whoever was beside
TEST(Gate, IsHaltedAtALittleBefore) {
  RoadScene here(testing::read_plain_net(two_lanes()));
  const std::size_t own = here.add("car", {"WE"}, 60, 0);
  here.traffic.gate[own] = 60.2;
  here.update();
  EXPECT_EQ(here.context(own).reason, LimitReason::Merge);
  EXPECT_EQ(here.context(own).allowed_speed, 0.0);
  here.traffic.gate[own] = 63.0;
  here.update();
  EXPECT_GT(here.context(own).allowed_speed, 0.0);
}

}  // namespace
}  // namespace sumogamma
