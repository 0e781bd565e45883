#include "traffic/junction/arbitration.h"

#include <gtest/gtest.h>

#include "model/context.h"
#include "model/gamma_velocity.h"
#include "road/path_pieces.h"
#include "support/lights.h"
#include "support/road_scene.h"
#include "support/small_net.h"
#include "traffic/longitudinal/merging.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::PlainNet;
using testing::read_plain_net;
using testing::RoadScene;
using testing::show;
using testing::show_across_green;

// --- signals: small_net, where link 0 of signal C drives from `in` to `out`

class SignalTest : public ::testing::Test {
 protected:
  void show(char letter) { here_.road.signal_states[0] = std::string(1, letter) + "r"; }
  RoadScene here_{testing::small_net()};
};

TEST_F(SignalTest, RedStopsAndGreenDoesNot) {
  const std::size_t own = here_.add("car", {"in", "out"}, 68, 10);
  show('r');
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own).allowed_speed, 10.0);
  show('G');
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::Signal);
  EXPECT_GT(here_.context(own).allowed_speed, 10.0);
}

TEST_F(SignalTest, RedHoldsWhoStandsAtTheLine) {
  const std::size_t own = here_.add("car", {"in", "out"}, 95 - 2.25 - 0.5, 0);
  show('r');
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own).allowed_speed, 0.1);
}

// A motorcycle that drifted over the edge of its lane while it braked for amber took itself for too
// near to halt, drove on and passed at red.
TEST_F(SignalTest, AmberHoldsWhoGetsOverTheEdgeOfItsLaneAtTheLine) {
  const std::size_t own = here_.add("motorcycle", {"in", "out"}, 60, 0.5);
  const PathLink& link = here_.path(own).links.front();
  const double half = 0.5 * type_of(here_.model.types, here_.scene.type[own]).length;
  show('y');
  for (const double before : {1.0, 0.8, 0.7, 0.65}) {
    here_.move(own, link.stop_line - half - before, 1.5);
    here_.update();
    EXPECT_EQ(here_.context(own).reason, LimitReason::Signal) << before;
    EXPECT_LT(here_.context(own).allowed_speed, 0.5) << before;
  }
}

// A bus that braked for amber came to rest a hand's breadth before its line, as it turned there,
// took itself for too near to halt, rolled on and was over the line at red.
TEST_F(SignalTest, WhoCrawlsBeforeTheLineLateAtAmberStands) {
  const std::size_t own = here_.add("bus", {"in", "out"}, 60, 0.3);
  show('y');
  here_.scene.time = 100;
  auto is_held = [&](double since, double before) {
    here_.road.signal_since.assign(here_.road.signal_states.size(), 100 - since);
    here_.move(own, here_.path(own).links.front().stop_line - 6.0 - before);
    here_.update();
    return here_.context(own).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(is_held(2.6, 0.1));
  EXPECT_TRUE(is_held(2.0, 0.18));
  EXPECT_FALSE(is_held(0.1, 0.1)) << "it will be over the line in time";
}

// A bicycle that had a green arrow rode past the queue before it in the lane beside, which was red,
// and over that lane's line.
TEST(SignalBeside, WhoRidesWhollyInTheLaneBesideGoesByItsLight) {
  RoadScene here{testing::read_plain_net(testing::crossroads("traffic_light"))};
  const std::size_t own = here.add("bicycle", {"WC", "CE"}, 20, 3, 0, -1, "WC_1");
  auto is_held = [&](double aside, char beside) {
    show(here, "WC_1", 'G');
    show(here, "WC_0", beside);
    here.move(own, here.path(own).links.front().stop_line - 4.0, -aside);
    here.update();
    return here.context(own).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(is_held(3.2, 'r'));
  EXPECT_FALSE(is_held(3.2, 'G'));
  EXPECT_FALSE(is_held(0.0, 'r')) << "its own lane has green";
  EXPECT_FALSE(is_held(1.5, 'r')) << "on the edge of its lane";
}

// --- the gap that amber makes: a car that turns left, and one that comes towards it

class AmberGap : public ::testing::Test {
 protected:
  AmberGap() {
    own_ = here_.add("car", {"WC", "CN"}, 20, 0, 0, -1, "WC_1");
    oncomer_ = here_.add("car", {"EC", "CW"}, 20, 10, 0, -1, "EC_0");
    here_.scene.time = 100;
    stand(0.5, 80);
    come(50);
  }
  /// The one that turns stands so far before its line [m], since a time [s].
  void stand(double before, double since) {
    const PathLink& link = here_.path(own_).links.front();
    here_.move(own_, link.stop_line - 2.25 - before);
    here_.traffic.halted_for[own_] = link.connection;
    here_.traffic.halted_at[own_] = since;
  }
  /// The other comes at 10 m/s, with so much way to its line [m].
  void come(double before) {
    here_.move(oncomer_, here_.path(oncomer_).links.front().stop_line - 2.25 - before, 10);
  }
  /// What holds the one that turns so long after both lights showed a letter [s].
  LimitReason held_by(char letter, double since) {
    show(here_, "WC_1", letter);
    show(here_, "EC_0", letter);
    here_.road.signal_since.assign(here_.road.signal_states.size(), 100 - since);
    here_.update();
    return here_.context(own_).reason;
  }
  RoadScene here_{read_plain_net(crossroads("traffic_light"))};
  std::size_t own_ = 0, oncomer_ = 0;
};

TEST_F(AmberGap, IsTakenByWhoStoodAtItsLine) {
  EXPECT_EQ(held_by('g', 15), LimitReason::Yield);
  EXPECT_EQ(held_by('y', 0.5), LimitReason::None);
  EXPECT_EQ(held_by('y', 2.2), LimitReason::Signal) << "it would not be over the line before red";
  EXPECT_EQ(held_by('r', 0.5), LimitReason::Signal);
}

TEST_F(AmberGap, IsNotForWhoComesLate) {
  stand(0.5, 99.8);
  EXPECT_EQ(held_by('y', 0.5), LimitReason::Signal);
  stand(3.0, 80);
  EXPECT_EQ(held_by('y', 0.5), LimitReason::Signal) << "not near its line";
}

TEST_F(AmberGap, IsNoneBeforeWhoCannotHaltAtEase) {
  come(15);
  EXPECT_EQ(held_by('y', 0.5), LimitReason::Yield);
}

// A bicycle that turned left stood before one of two lanes and waited for the other: through the
// green of both, as nobody there let it go.
TEST(HoldingUp, WhoStandsInTheWayOfOneLaneIsLetPastByTheOther) {
  RoadScene here{read_plain_net(crossroads("traffic_light"))};
  for (const char* lane : {"WC_1", "EC_0", "EC_1"}) show(here, lane, lane[0] == 'W' ? 'g' : 'G');
  const std::size_t own = here.add("bicycle", {"WC", "CN"}, 20, 0, 0, -1, "WC_1");
  const std::size_t held = here.add("car", {"EC", "CW"}, 20, 0, 0, -1, "EC_1");
  const std::size_t other = here.add("car", {"EC", "CW"}, 20, 7, 0, -1, "EC_0");
  const ConnectionId first = here.path(held).links.front().connection;
  const PathLink& link = here.path(own).links.front();
  const auto& zones = here.model.conflicts[index_of(link.connection)];
  const auto zone = std::find_if(zones.begin(), zones.end(), [&](const ConflictZone& candidate) {
    return candidate.foe == first;
  });
  ASSERT_NE(zone, zones.end());
  here.move(own, link.stop_line + zone->begin + 0.5);
  here.move(held, here.path(held).links.front().stop_line - 0.6 - 2.25);
  here.move(other, here.path(other).links.front().stop_line - 12.0 - 2.25);
  for (const double stood : {1.0, 4.0}) {
    here.scene.held[held].standing = stood;
    here.update(2);
    ASSERT_EQ(here.context(held).foe, here.scene.id[own].value);
    const bool lets_past = here.context(other).foe == here.scene.id[own].value;
    EXPECT_EQ(lets_past, stood > 2.0);
    const bool waits = here.context(own).foe == here.scene.id[other].value;
    EXPECT_EQ(waits, stood < 2.0);
  }
}

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

// --- who turns left out of the lane at the kerb, over the lane beside, which has the same green

class LeftFromTheKerb : public ::testing::Test {
 protected:
  static PlainNet net() {
    PlainNet plain = crossroads("traffic_light");
    plain.connections =
        "<connection from='WC' to='CN' fromLane='0' toLane='0'/>"
        "<connection from='WC' to='CE' fromLane='0' toLane='0'/>"
        "<connection from='WC' to='CE' fromLane='1' toLane='1'/>";
    return plain;
  }
  LeftFromTheKerb() { here_.scene.time = 200; }
  std::size_t add_rider(const std::string& type, double halted_for) {
    const std::size_t rider = here_.add(type, {"WC", "CN"}, 20, 0, 0, -1, "WC_0");
    const PathLink& link = here_.path(rider).links.front();
    here_.move(rider, link.stop_line - 0.6 -
                          0.5 * type_of(here_.model.types, here_.scene.type[rider]).length);
    here_.traffic.halted_for[rider] = link.connection;
    here_.traffic.halted_at[rider] = 200 - halted_for;
    return rider;
  }
  std::size_t add_car(double before, double speed) {
    const std::size_t car = here_.add("car", {"WC", "CE"}, 20, speed, 0, -1, "WC_1");
    here_.move(car, here_.path(car).links.front().stop_line - before - 2.25);
    return car;
  }
  void update(char letter, double since) {
    show(here_, "WC_0", letter);
    show(here_, "WC_1", letter);
    here_.road.signal_since.assign(here_.road.signal_states.size(), 200 - since);
    here_.update(2);
  }
  RoadScene here_{read_plain_net(net())};
};

// bicycles stood through three greens, since the lane beside never had a gap
TEST_F(LeftFromTheKerb, ACyclistWhoMissedAGreenGoesFirstAtTheNext) {
  const std::size_t rider = add_rider("bicycle", 100);
  const std::size_t car = add_car(0.6, 0);
  const auto rider_id = static_cast<std::int64_t>(here_.scene.id[rider].value);
  update('g', 1.0);
  EXPECT_EQ(here_.context(rider).reason, LimitReason::None);
  EXPECT_EQ(here_.context(car).foe, rider_id);
  update('g', 10.0);
  EXPECT_EQ(here_.context(rider).reason, LimitReason::Yield) << "not amid the green";
  EXPECT_EQ(here_.context(car).reason, LimitReason::None);
  here_.traffic.halted_at[rider] = 200 - 50;
  update('g', 1.0);
  EXPECT_EQ(here_.context(rider).reason, LimitReason::Yield) << "it came at red";
  EXPECT_EQ(here_.context(car).reason, LimitReason::None);
}

TEST_F(LeftFromTheKerb, ADriverWaitsForAGap) {
  const std::size_t rider = add_rider("motorcycle", 80);
  add_car(0.6, 0);
  update('g', 1.0);
  EXPECT_EQ(here_.context(rider).reason, LimitReason::Yield);
}

TEST_F(SignalTest, WhoStandsDownTheQueueKnowsThatItIsRed) {
  const std::size_t own = here_.add("car", {"in", "out"}, 30, 0);
  here_.scene.held[own].standing = 5.0;
  show('r');
  here_.update();
  EXPECT_TRUE(here_.context(own).at_red);
  show('G');
  here_.update();
  EXPECT_FALSE(here_.context(own).at_red);
}

TEST_F(SignalTest, AmberStopsWhoCanStopAtEaseAndLetsTheOthersThrough) {
  show('y');
  const std::size_t far = here_.add("car", {"in", "out"}, 50, 10);
  here_.update();
  EXPECT_EQ(here_.context(far).reason, LimitReason::Signal);
  RoadScene other(testing::small_net());
  other.road.signal_states[0] = "yr";
  const std::size_t near = other.add("car", {"in", "out"}, 83, 13);
  other.update();
  EXPECT_NE(other.context(near).reason, LimitReason::Signal);
}

// Amber of one second: who reckoned with two and a half drove on from where it could halt still,
// and passed at red.
TEST_F(SignalTest, WhoGetsOverNoMoreWithinAShortAmberBrakesAsHardAsItCan) {
  const std::size_t own = here_.add("car", {"in", "out"}, 60, 13);
  show('y');
  here_.scene.time = 100;
  here_.road.signal_since.assign(here_.road.signal_states.size(), 100);
  auto is_held = [&](double lasts, double before) {
    here_.road.amber_until.assign(here_.road.signal_states.size(), 100 + lasts);
    here_.move(own, here_.path(own).links.front().stop_line - 2.25 - before);
    here_.update();
    return here_.context(own).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(is_held(1.0, 14.5));
  EXPECT_FALSE(is_held(1.0, 12.5)) << "it gets over";
  EXPECT_FALSE(is_held(3.0, 14.5)) << "it gets over";
}

TEST_F(SignalTest, WhoIsInsideClearsTheJunction) {
  show('r');
  const std::size_t own = here_.add("car", {"in", "out"}, 97, 5);
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::Signal);
  EXPECT_GT(here_.context(own).allowed_speed, 5.0);
}

TEST_F(SignalTest, AnUnknownStateIsNoSignal) {
  here_.road.signal_states.clear();
  const std::size_t own = here_.add("car", {"in", "out"}, 60, 10);
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::Signal);
}

// --- priority: WE is the major road, NS gives way

class PriorityTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("priority"));
    return network;
  }
  /// A car that stands before the line of its first link.
  std::size_t add_at_line(const std::vector<std::string>& edges, const std::string& lane = "") {
    const std::size_t row = here_.add("car", edges, 0, 0, 0, -1, lane);
    here_.move(row, here_.path(row).links.front().stop_line - 2.25 - 0.6);
    return row;
  }
  /// Where the ways of two cars over their first links are in each other's.
  ConflictZone conflict_of(std::size_t row, std::size_t other) const {
    const PathLink& link = here_.path(row).links.front();
    const ConnectionId foe = here_.path(other).links.front().connection;
    for (const ConflictZone& zone : here_.model.conflicts[index_of(link.connection)])
      if (zone.foe == foe && zone.of_narrow) return *zone_for(zone, false);
    ADD_FAILURE() << "their ways don't cross";
    return {};
  }
  /// Where the way of `row` begins to be in that of `other` [m along its path].
  double zone_of(std::size_t row, std::size_t other) const {
    return here_.path(row).links.front().stop_line + conflict_of(row, other).begin;
  }
  RoadScene here_{net()};
};

TEST_F(PriorityTest, TheMinorRoadWaitsForWhoArrivesAtTheSameTime) {
  const std::size_t minor = here_.add("car", {"SC", "CN"}, 172, 8);
  const std::size_t major = here_.add("car", {"WC", "CE"}, 150, 12);
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(minor).foe, here_.scene.id[major].value);
  EXPECT_LT(here_.context(minor).allowed_speed, 8.0);
  EXPECT_NE(here_.context(major).reason, LimitReason::Yield);
  EXPECT_GT(here_.context(major).allowed_speed, 12.0);
}

TEST_F(PriorityTest, TheMinorRoadGoesThroughAGap) {
  const std::size_t minor = here_.add("car", {"SC", "CN"}, 185, 6);
  here_.add("car", {"WC", "CE"}, 20, 8);  // twenty seconds away
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::None);
}

TEST_F(PriorityTest, TheTypeSaysHowLargeAGapHasToBe) {
  const std::size_t minor = here_.add("car", {"SC", "CN"}, 176, 7);
  here_.add("car", {"WC", "CE"}, 110, 10);
  AgentType& car = here_.model.types[static_cast<std::size_t>(here_.scene.type[minor])];
  car.critical_gap = 0.5;
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::None);
  car.critical_gap = 8.0;
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield);
}

TEST_F(PriorityTest, WhoTurnsInWaitsForWhoWouldHaveToBrakeHard) {
  const std::size_t minor = add_at_line({"SC", "CE"}, "SC_0");
  const std::size_t major = here_.add("car", {"WC", "CE"}, 0, 13, 0, -1, "WC_0");
  const double line = here_.path(major).links.front().stop_line;
  // it would be out of the place where the ways meet a second before, but slow for seconds more
  here_.move(major, line - 58);
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(minor).foe, here_.scene.id[major].value);
  // who has waited for a minute asks for more
  here_.traffic.waiting_time[minor] = 60;
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::None);
  here_.traffic.waiting_time[minor] = 0;
  here_.move(major, line - 110);
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::None);
}

// it had waited until who passes was out of the place where the ways meet, and a second longer; an
// entry of a roundabout took three quarters of the vehicles that the Highway Capacity Manual
// expects
TEST_F(PriorityTest, WhoTurnsInGoesRightBehindWhoPassesAndWhoCrossesWaits) {
  const std::size_t passing = here_.add("car", {"WC", "CE"}, 0, 10, 0, -1, "WC_0");
  const std::size_t joining = add_at_line({"SC", "CE"}, "SC_0");
  const ConflictZone zone = conflict_of(joining, passing);
  // its rear is out of the way a moment before our front comes there
  here_.move(passing, 0);
  const double first = here_.occupation_of(joining, zone.begin, zone.end).begin;
  double at = here_.path(passing).links.front().stop_line;
  auto leaves = [&] { return here_.occupation_of(passing, zone.foe_begin, zone.foe_end).end; };
  for (here_.move(passing, at); leaves() > first - 0.5; here_.move(passing, at)) at += 0.5;
  here_.update();
  EXPECT_EQ(here_.context(joining).reason, LimitReason::None);
  for (here_.move(passing, at); leaves() < first - 0.1; here_.move(passing, at)) at -= 0.5;
  here_.update();
  EXPECT_EQ(here_.context(joining).reason, LimitReason::Yield);
}

TEST_F(PriorityTest, WhoTurnsInGoesBeforeWhoComesLaterAndNeedNotBrakeHard) {
  const std::size_t joining = add_at_line({"SC", "CE"}, "SC_0");
  const std::size_t coming = here_.add("car", {"WC", "CE"}, 0, 5, 0, -1, "WC_0");
  here_.scene.preferred_speed[coming] = 5;
  const ConflictZone zone = conflict_of(joining, coming);
  double at = here_.path(coming).links.front().stop_line - 60;
  auto arrives = [&] { return here_.occupation_of(coming, zone.foe_begin, zone.foe_end).begin; };
  const Occupation own = here_.occupation_of(joining, zone.begin, zone.end);
  for (here_.move(coming, at); arrives() > own.begin + 2.2; here_.move(coming, at)) at += 0.5;
  EXPECT_LT(arrives(), own.end + 1.0) << "who crosses would wait";
  here_.update();
  EXPECT_EQ(here_.context(joining).reason, LimitReason::None);
  // faster it would have to brake hard
  here_.scene.preferred_speed[coming] = 13;
  here_.set_speed(coming, 13);
  for (here_.move(coming, at); arrives() < own.begin + 1.3; here_.move(coming, at)) at -= 0.5;
  here_.update();
  EXPECT_EQ(here_.context(joining).reason, LimitReason::Yield);
}

TEST_F(PriorityTest, OfTwoFromMinorRoadsWhoHasBegunToCrossFinishes) {
  const std::size_t turning = here_.add("car", {"SC", "CW"}, 0, 4);
  here_.move(turning, here_.path(turning).links.front().stop_line + 4.0 - 2.25);
  const std::size_t straight = add_at_line({"NC", "CS"});
  here_.update();
  EXPECT_EQ(here_.context(straight).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(straight).foe, here_.scene.id[turning].value);
  EXPECT_EQ(here_.context(turning).reason, LimitReason::None);
  // at their lines the one that goes straight on has the right of way
  here_.move(turning, here_.path(turning).links.front().stop_line - 0.6 - 2.25);
  here_.set_speed(turning, 0);
  for (const std::size_t row : {turning, straight}) here_.scene.context[row] = {};
  here_.update();
  EXPECT_NE(here_.context(straight).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(turning).reason, LimitReason::Yield);
}

TEST_F(PriorityTest, SomebodyWhoHasPassedHoldsNobody) {
  const std::size_t minor = here_.add("car", {"SC", "CN"}, 185, 6);
  here_.add("car", {"WC", "CE"}, 225, 10);
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::None);
}

TEST_F(PriorityTest, WhoStandsOnTheJunctionHoldsEvenTheMajorRoad) {
  const std::size_t blocker = here_.add("bus", {"SC", "CN"}, 0, 0);
  // across the eastbound lanes
  here_.move(blocker, here_.path(blocker).line.project(Vec2(0, -3)).along);
  const std::size_t major = here_.add("car", {"WC", "CE"}, 160, 12);
  here_.update();
  EXPECT_EQ(here_.context(major).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(major).foe, here_.scene.id[blocker].value);
  EXPECT_LT(here_.context(major).allowed_speed, 12.0);
}

// zones drawn for buses held cars where there was room for two of them
TEST_F(PriorityTest, WhereACarGetsPastABusIsHeld) {
  auto reason_for = [](const std::string& type) {
    RoadScene here{net()};
    const std::size_t own = here.add(type, {"WC", "CE"}, 150, 8, 0, -1, "WC_0");
    const std::size_t foe = here.add("car", {"SC", "CN"}, 0, 0);
    const PathLink& link = here.path(foe).links.front();
    for (const ConflictZone& zone : here.model.conflicts[index_of(link.connection)])
      if (zone.foe == here.path(own).links.front().connection)
        here.move(foe, link.stop_line + zone.begin + 0.5 - 2.25);
    here.update();
    return here.context(own).reason;
  };
  EXPECT_EQ(reason_for("car"), LimitReason::None);
  EXPECT_EQ(reason_for("bus"), LimitReason::Yield);
}

TEST_F(PriorityTest, ALeftTurnWaitsForOncomingTraffic) {
  const std::size_t turning = here_.add("car", {"WC", "CN"}, 175, 6);
  const std::size_t oncoming = here_.add("car", {"EC", "CW"}, 160, 12);
  here_.update();
  EXPECT_EQ(here_.context(turning).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(turning).foe, here_.scene.id[oncoming].value);
  EXPECT_NE(here_.context(oncoming).reason, LimitReason::Yield);
}

TEST_F(PriorityTest, OfTwoThatWaitForEachOtherOneGoes) {
  // both stand at their lines and each says that it waits for the other
  const std::size_t a = here_.add("car", {"WC", "CN"}, 0, 0);
  const std::size_t b = here_.add("car", {"EC", "CW"}, 0, 0);
  for (const std::size_t row : {a, b})
    here_.move(row, here_.path(row).links.front().stop_line - 2.25 - 0.6);
  for (const std::size_t row : {a, b}) {
    here_.scene.context[row].reason = LimitReason::Yield;
    here_.scene.context[row].foe = here_.scene.id[row == a ? b : a].value;
  }
  here_.traffic.waiting_time[a] = 20;
  here_.traffic.waiting_time[b] = 10;
  here_.update();
  const bool first_goes = here_.context(a).reason != LimitReason::Yield;
  const bool second_goes = here_.context(b).reason != LimitReason::Yield;
  EXPECT_TRUE(first_goes || second_goes);
}

TEST_F(PriorityTest, NobodyEntersAJunctionWithoutRoomBehindIt) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 5, 0, -1, "WC_0");
  const double end = here_.path(own).links.front().end;
  here_.move(own, here_.path(own).links.front().stop_line - 12);
  const std::size_t queue = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(queue, end + 2.25 + 1.0);
  here_.set_speed(queue, 0);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::BlockedJunction);
  EXPECT_EQ(here_.context(own).foe, here_.scene.id[queue].value);
}

// into a road that was full nobody from the side road got in for minutes
TEST_F(PriorityTest, IntoAFullRoadDriversLetOneInWhoHasWaitedForLong) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 3, 0, -1, "WC_0");
  const PathLink& link = here_.path(own).links.front();
  here_.move(own, link.stop_line - 12);
  const std::size_t queue = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  // room for one
  here_.move(queue, link.end + 4.5 + 3.0 + 2.25);
  const std::size_t minor = here_.add("car", {"SC", "CE"}, 0, 0);
  const PathLink& turn = here_.path(minor).links.front();
  ASSERT_EQ(here_.model.road.connection(turn.connection).to,
            here_.model.road.connection(link.connection).to);
  here_.move(minor, turn.stop_line - 2.25 - 0.6);
  here_.scene.time = 100;
  here_.traffic.halted_for[minor] = turn.connection;
  here_.traffic.halted_at[minor] = 90;
  here_.update(2);
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield);
  EXPECT_NE(here_.context(own).reason, LimitReason::BlockedJunction) << "not yet for long";
  here_.traffic.halted_at[minor] = 70;
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::BlockedJunction);
  // it stands and lets the other go
  here_.move(own, link.stop_line - 2.25 - 0.6);
  here_.set_speed(own, 0);
  here_.update(2);
  EXPECT_NE(here_.context(minor).reason, LimitReason::Yield);
  // nor where the road isn't full
  here_.set_speed(queue, 10);
  here_.update(2);
  EXPECT_NE(here_.context(own).reason, LimitReason::BlockedJunction);
}

// who had the right of way drove off with every surge of its queue, and nobody else ever got in
TEST_F(PriorityTest, WhoStandsBeforeAFullRoadLetsInWhoCameToItsLineBefore) {
  const std::size_t own = add_at_line({"WC", "CE"}, "WC_0");
  const PathLink& link = here_.path(own).links.front();
  const std::size_t minor = add_at_line({"SC", "CE"});
  const PathLink& turn = here_.path(minor).links.front();
  here_.scene.time = 100;
  auto came = [&](double own_at, double minor_at) {
    here_.traffic.halted_for = {link.connection, turn.connection};
    here_.traffic.halted_at = {own_at, minor_at};
    here_.scene.context.assign(2, {});
    here_.traffic.waiting_time = {3.0, 5.0};  // it inched on
    here_.update(2);                          // the other one sees that it is let in
  };
  came(80, 70);
  EXPECT_EQ(here_.context(own).reason, LimitReason::LetsIn);
  EXPECT_EQ(here_.context(own).foe, here_.scene.id[minor].value);
  EXPECT_NE(here_.context(minor).reason, LimitReason::Yield);
  came(60, 70);
  EXPECT_NE(here_.context(own).reason, LimitReason::LetsIn) << "the other one came later";
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield);
  came(97, 95);
  EXPECT_NE(here_.context(own).reason, LimitReason::LetsIn) << "but just before";
  came(80, 70);
  EXPECT_EQ(here_.context(own).reason, LimitReason::LetsIn);
  here_.traffic.waiting_time[own] = 80.0;
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::LetsIn) << "queues stand for a minute";
  came(80, 70);
  here_.traffic.waiting_time[own] = 130.0;
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::LetsIn) << "not for ever";
  came(80, 70);
  // a bicycle let in the second of a queue, for 107 s
  here_.move(minor, turn.stop_line - 2.25 - 4.0);
  here_.scene.context[own].reason = LimitReason::Signal;
  here_.scene.context[minor].reason = LimitReason::Leader;
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::LetsIn) << "nor who stands in a queue";
  here_.move(minor, turn.stop_line - 2.25 - 0.6);
  // who is let in and then has somebody else to wait for is left behind
  const std::size_t other = here_.add("car", {"EC", "CW"}, 100, 0);
  here_.scene.context.assign(3, {});
  here_.traffic.halted_at[own] = 80;
  here_.traffic.halted_at[minor] = 70;
  here_.scene.context[minor].reason = LimitReason::Yield;
  here_.scene.context[minor].foe = here_.scene.id[other].value;
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::LetsIn);
}

// a truck stood for two minutes at a line with priority, one after the other from the minor road
// before it, in the queue before the next light
TEST_F(PriorityTest, WhoHasStoodForLongWithTheRightOfWayComesNext) {
  const std::size_t major = add_at_line({"WC", "CE"}, "WC_0");
  const std::size_t minor = add_at_line({"SC", "CN"});
  const std::size_t third = here_.add("car", {"NC", "CS"}, 0, 0);
  here_.move(third, here_.path(third).links.front().stop_line + 8.0);
  const auto waits_after = [&](double stood) {
    RoadContext& context = here_.scene.context[major];
    context.active = true;
    context.reason = LimitReason::Yield;
    context.foe = here_.scene.id[third].value;
    here_.scene.held[major].standing = here_.traffic.waiting_time[major] = stood;
    here_.traffic.waiting_time[minor] = 5.0;
    here_.update();
    return here_.context(minor).foe == here_.scene.id[major].value;
  };
  EXPECT_FALSE(waits_after(10.0));
  EXPECT_TRUE(waits_after(25.0));
}

// the next of the row drove on behind whoever stood on the junction before it, and who had the
// longer wait for that one never got in
TEST_F(PriorityTest, WhoWaitsForTheRowToLeaveTheJunctionIsLetInBehindIt) {
  const std::size_t own = add_at_line({"WC", "CE"}, "WC_0");
  const PathLink& link = here_.path(own).links.front();
  const std::size_t ahead = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(ahead, link.end - 1.0);
  const std::size_t minor = add_at_line({"SC", "CE"});
  const PathLink& turn = here_.path(minor).links.front();
  const std::size_t other = here_.add("car", {"EC", "CW"}, 0, 0);
  here_.scene.time = 100;
  here_.traffic.halted_for = {link.connection, kNoConnection, turn.connection, kNoConnection};
  const auto reason_after = [&](double wait, std::size_t foe) {
    here_.traffic.halted_at = {90, 0, 100 - wait, 0};
    here_.scene.context.assign(4, {});
    here_.scene.context[minor].reason = LimitReason::Yield;
    here_.scene.context[minor].foe = here_.scene.id[foe].value;
    here_.traffic.waiting_time = {3.0, 3.0, wait, 3.0};
    // it has kept the junction clear for long
    here_.traffic.keeps_clear[own] = 45.0;
    here_.update();
    return here_.context(own).reason;
  };
  EXPECT_EQ(reason_after(30, ahead), LimitReason::LetsIn);
  EXPECT_EQ(here_.context(own).foe, here_.scene.id[minor].value);
  EXPECT_NE(reason_after(15, ahead), LimitReason::LetsIn) << "not yet for long";
  EXPECT_NE(reason_after(30, other), LimitReason::LetsIn) << "it waits for others than the row";
}

// with the 40 m that following needs, a queue of 60 m before a red light was taken for one that
// goes on: its end stood on the junction, and side roads waited for minutes
TEST_F(PriorityTest, AQueueIsSeenUpToItsHead) {
  const std::size_t own = add_at_line({"WC", "CE"}, "WC_0");
  const PathLink& link = here_.path(own).links.front();
  // somebody drives close ahead, into a queue that stands beyond what following looks at
  const std::size_t first = here_.add("car", {"WC", "CE"}, 0, 5, 0, -1, "WC_0");
  here_.move(first, link.end + 6.0);
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::BlockedJunction) << "it goes on";
  for (const double place : {12.0, 18.0, 24.0, 30.0, 36.0, 42.0, 48.0, 54.0, 60.0, 66.0}) {
    const std::size_t row = here_.add("car", {"WC", "CE"}, 0, 5, 0, -1, "WC_0");
    here_.move(row, link.end + place);
  }
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::BlockedJunction) << "they all do";
  const std::size_t last = here_.add("truck", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(last, link.end + 73.0);
  for (std::size_t row = first; row < last; ++row) here_.set_speed(row, 2.0);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::BlockedJunction);
}

// a bus came to rest at the edge of the place where their ways cross, took itself for being in
// there, rolled on and met the other nose to nose
TEST_F(PriorityTest, WhoHasComeToRestAtAZonesEdgeWaitsThereForWhoIsInItsWay) {
  const std::size_t own = here_.add("car", {"SC", "CN"}, 0, 0.4);
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 0, 2, 0, -1, "WC_0");
  for (const double past : {-0.2, 0.2}) {
    here_.move(own, zone_of(own, foe) - 2.25 + past);
    const auto waits = [&](double into, double speed) {
      here_.move(foe, zone_of(foe, own) - 2.25 + into);
      here_.set_speed(foe, speed);
      here_.update();
      return here_.context(own).reason == LimitReason::Yield;
    };
    EXPECT_TRUE(waits(4.25, 2.0)) << past;
    // a bus drove on towards a van that stood there for a second and went on, too
    EXPECT_TRUE(waits(4.25, 0.0)) << past << ": who stands in the way";
    EXPECT_FALSE(waits(0.35, 0.0)) << past << ": past who stands beside it";
  }
}

// a truck that drove by a van forgot that it had waited itself, and halted in the van's way
TEST_F(PriorityTest, WhoIsDrivingByWhoWaitsForAThirdGoesOn) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 3, 0, -1, "WC_0");
  const std::size_t foe = here_.add("car", {"SC", "CN"}, 0, 0);
  const std::size_t third = here_.add("car", {"EC", "CW"}, 0, 8, 0, -1, "EC_0");
  const auto waits = [&](double begun, double wait) {
    here_.move(own, here_.path(own).links.front().stop_line - 2.25 + begun);
    here_.move(foe, zone_of(foe, own) - 2.25 + 0.35);
    here_.scene.context[own].active = true;
    here_.scene.context[own].reason = LimitReason::None;
    here_.scene.context[foe].reason = LimitReason::Yield;
    here_.scene.context[foe].foe = here_.scene.id[third].value;
    here_.traffic.waiting_time[foe] = wait;
    here_.update();
    return here_.context(own).reason == LimitReason::Yield;
  };
  EXPECT_FALSE(waits(0.4, 10));
  EXPECT_TRUE(waits(0.4, 2)) << "it may go at any time";
  EXPECT_TRUE(waits(-1, 10)) << "from the line one looks first";
}

// the second of a queue that sets out waited at the line until the first was fast
TEST_F(PriorityTest, WhoFollowsAQueueThatSetsOutDoesNotWaitForRoom) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 1, 0, -1, "WC_0");
  const PathLink& link = here_.path(own).links.front();
  here_.move(own, link.stop_line - 2.25 - 1.5);
  const std::size_t ahead = here_.add("car", {"WC", "CE"}, 0, 2, 0, -1, "WC_0");
  here_.move(ahead, link.end - 1.0);
  here_.scene.context[ahead] = {};
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::BlockedJunction);
  // it will have to halt there
  here_.scene.context[ahead].reason = LimitReason::Yield;
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::BlockedJunction);
}

// Round a block whose roads are all full somebody has to lend the queue the room of a junction.
TEST_F(PriorityTest, WhoHasKeptAJunctionClearForLongGoesOnForAWhile) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  const double end = here_.path(own).links.front().end;
  here_.move(own, here_.path(own).links.front().stop_line - 2.25 - 0.6);
  const std::size_t queue = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(queue, end + 2.25 + 1.0);
  const double blocked = here_.held_for(own, LimitReason::BlockedJunction, 60.0);
  EXPECT_NEAR(60.0 - blocked, 10.0, 1.5);
  EXPECT_GT(blocked, 40.0);
}

// four who each kept a junction of a roundabout clear for the next one stood for five minutes
TEST_F(PriorityTest, WhoKeepsAJunctionClearForItselfInTheEndGoesOnSooner) {
  const std::size_t own = add_at_line({"WC", "CE"}, "WC_0");
  const std::size_t queue = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(queue, here_.path(own).links.front().end + 2.25 + 1.0);
  const std::size_t third = here_.add("car", {"NC", "CS"}, 150, 0);
  auto blocked_for = [&](std::int64_t third_waits_for) {
    here_.traffic.keeps_clear[own] = 0.0;
    double blocked = 0;
    for (double time = 0; time < 30.0; time += 0.5) {
      here_.scene.context[queue].foe = here_.scene.id[third].value;
      here_.scene.context[third].foe = third_waits_for;
      here_.update(1, 0.5);
      if (here_.context(own).reason == LimitReason::BlockedJunction) blocked += 0.5;
    }
    return blocked;
  };
  EXPECT_EQ(blocked_for(-1), 30.0);
  EXPECT_NEAR(blocked_for(here_.scene.id[own].value), 20.0, 1.5);
}

/// A west-east road over two junctions so many metres apart, where another road crosses it each.
///
///         NA   N           edges are named after their ends: AB runs from A to B
///         |    |
///    W ---A----B--- E
///         |    |
///         SA   S
RoadNetwork two_junctions(int apart, const std::string& type_of_b) {
  testing::PlainNet plain;
  const std::string b = std::to_string(apart);
  plain.nodes =
      "<node id='W' x='-100' y='0'/><node id='A' x='0' y='0' type='priority'/>"
      "<node id='NA' x='0' y='100'/><node id='SA' x='0' y='-100'/>"
      "<node id='E' x='120' y='0'/><node id='B' x='" +
      b + "' y='0' type='" + type_of_b + "'/><node id='N' x='" + b + "' y='100'/><node id='S' x='" +
      b + "' y='-100'/>";
  for (const char* ends : {"W A", "A B", "B E"})
    plain.edges += std::string("<edge id='") + ends[0] + ends[2] + "' from='" + ends[0] + "' to='" +
                   ends[2] + "' priority='1' speed='13'/>";
  plain.edges +=
      "<edge id='NAA' from='NA' to='A' priority='1' speed='13'/>"
      "<edge id='ASA' from='A' to='SA' priority='1' speed='13'/>"
      "<edge id='NB' from='N' to='B' priority='9' speed='13'/>"
      "<edge id='BS' from='B' to='S' priority='9' speed='13'/>";
  return read_plain_net(plain);
}

// A bicycle that rolled on by centimetres before the first of two junctions waited for ever. Eight
// metres are left between them: who waits before B has its rear on A.
TEST(JunctionsThatFollowClosely, AreKeptClearForSomeTimeThoughSomebodyCreeps) {
  RoadScene here(two_junctions(16, "priority"));
  const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
  here.move(own, here.path(own).links.at(0).stop_line - 2.25 - 0.6);
  const std::size_t foe = here.add("car", {"NB", "BS"}, 0, 10);
  here.move(foe, here.path(foe).links.at(0).stop_line - 32);
  here.update();
  EXPECT_EQ(here.context(own).foe, here.scene.id[foe].value);
  here.scene.held[own].standing = 0.5;
  here.traffic.waiting_time[own] = 25;
  here.update();
  EXPECT_GT(here.context(own).allowed_speed, 0.3) << "it goes as far as B";

  // where it waits short of the line it doesn't halt again on its way from there to the line
  here.scene.held[own].standing = here.traffic.waiting_time[own] = 0;
  auto path = std::make_shared<Path>(here.path(own));
  path->links[0].halt -= 3.0;
  here.road.paths[static_cast<std::size_t>(here.scene.path[own])] = path;
  for (const double beyond : {-0.6, 1.0}) {
    here.move(own, path->links[0].halt + beyond - 2.25);
    here.update();
    EXPECT_EQ(here.context(own).allowed_speed > 0.3, beyond > 0.0) << beyond;
  }
}

// A bus waited on the second of two rings of the Magic Roundabout for the queue behind it, its rear
// in the way of both.
TEST(JunctionsThatFollowClosely, WhoseRoadBehindTheSecondIsFullWaitsBeforeTheFirst) {
  RoadScene here(two_junctions(16, "priority"));
  const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
  here.move(own, here.path(own).links.at(0).stop_line - 2.25 - 0.6);
  here.update();
  EXPECT_GT(here.context(own).allowed_speed, 0.3) << "the road is free";
  const std::size_t last = here.add("car", {"BE"}, 4, 0);
  here.scene.held[last].standing = 5;
  here.update();
  EXPECT_EQ(here.context(own).reason, LimitReason::BlockedJunction);
  EXPECT_EQ(here.context(own).foe, here.scene.id[last].value);
  EXPECT_LT(here.context(own).allowed_speed, 0.3);
  here.traffic.waiting_time[own] = 25;
  here.update();
  EXPECT_GT(here.context(own).allowed_speed, 0.3) << "it has been patient";
}

// On Meskel Square bicycles waited for three minutes to join a queue: the lane into which it moved
// on was 3 m long, the same road behind it, though.
TEST(JunctionsThatFollowClosely, WhoStandsLetsOneInWhereTheRoadGoesOnBehindTheSecond) {
  for (const bool goes_on : {true, false}) {
    SCOPED_TRACE(goes_on);
    const std::string road = goes_on ? "9" : "1", side = goes_on ? "1" : "9";
    testing::PlainNet plain;
    plain.nodes =
        "<node id='W' x='-100' y='0'/><node id='A' x='0' y='0' type='priority'/>"
        "<node id='B' x='20' y='0' type='priority'/><node id='E' x='150' y='0'/>"
        "<node id='SA' x='0' y='-100'/><node id='N' x='20' y='100'/>";
    plain.edges =
        "<edge id='WA' from='W' to='A' priority='9' speed='13'/>"
        "<edge id='AB' from='A' to='B' priority='" +
        road +
        "' speed='13'/>"
        "<edge id='BE' from='B' to='E' priority='9' speed='13'/>"
        "<edge id='SAA' from='SA' to='A' priority='1' speed='13'/>"
        "<edge id='NB' from='N' to='B' priority='" +
        side + "' speed='13'/>";
    RoadScene here(read_plain_net(plain));
    const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
    const std::size_t minor = here.add("car", {"SAA", "AB", "BE"}, 0, 0);
    for (const std::size_t row : {own, minor}) {
      const PathLink& link = here.path(row).links.front();
      here.move(row, link.halt - 2.25 - 0.6);
      here.traffic.halted_for[row] = link.connection;
    }
    here.scene.time = 100;
    here.traffic.halted_at = {80, 70};
    here.traffic.waiting_time = {3.0, 5.0};
    here.update(2);
    EXPECT_EQ(here.context(own).reason == LimitReason::LetsIn, goes_on);
  }
}

// Two motorcycles stood for 82 s at a stop sign right behind a line where they had priority: their
// halt counted for that line.
TEST(JunctionsThatFollowClosely, AHaltBeforeTheFirstCountsForTheStopSignOfTheSecond) {
  RoadScene here(two_junctions(8, "priority"));
  const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
  auto path = std::make_shared<Path>(here.path(own));
  here.model.road.connections[index_of(path->links[0].connection)].priority = LinkPriority::Major;
  here.model.road.connections[index_of(path->links[1].connection)].priority = LinkPriority::Stop;
  path->links[1].halt = path->links[0].stop_line + 0.5;
  here.road.paths[static_cast<std::size_t>(here.scene.path[own])] = path;
  here.move(own, path->links[1].halt - 0.7 - 2.25);
  here.update();
  EXPECT_EQ(here.context(own).reason, LimitReason::Yield);
  here.scene.held[own].standing = 1.0;
  here.update();
  EXPECT_EQ(here.context(own).reason, LimitReason::None);
}

// In Santa Maria everybody waited for a minute before an empty zebra: there was no room between it
// and the stop sign behind it, at which the halt before the zebra didn't count.
TEST(JunctionsThatFollowClosely, AHaltBeforeAZebraCountsForTheStopSignThatLeavesNoRoomBehindIt) {
  for (const LinkPriority priority :
       {LinkPriority::Major, LinkPriority::Minor, LinkPriority::Stop}) {
    SCOPED_TRACE(static_cast<int>(priority));
    RoadScene here(two_junctions(8, "priority"));
    const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
    const std::vector<PathLink> links = here.path(own).links;
    here.model.road.connections[index_of(links.at(0).connection)].priority = priority;
    here.model.road.connections[index_of(links.at(1).connection)].priority = LinkPriority::Stop;
    here.move(own, links[0].halt - 0.6 - 2.25);
    here.update();
    EXPECT_EQ(here.context(own).reason, LimitReason::Yield);
    here.scene.held[own].standing = 1.0;
    here.update();
    EXPECT_GT(here.context(own).allowed_speed, 0.3);
    here.scene.held[own].standing = 0.0;
    here.move(own, links[1].halt - 0.6 - 2.25);
    here.update();
    EXPECT_GT(here.context(own).allowed_speed, 0.3) << "it halts once";
  }
}

/// W to E over two signals with ten metres between them; a road from N crosses at the second.
RoadNetwork two_boxes() {
  testing::PlainNet plain;
  plain.nodes =
      "<node id='W' x='-100' y='0'/><node id='E' x='200' y='0'/>"
      "<node id='A' x='0' y='0' type='traffic_light'/>"
      "<node id='B' x='24' y='0' type='traffic_light'/><node id='N' x='0' y='100'/>"
      "<node id='S' x='0' y='-100'/><node id='M' x='24' y='100'/><node id='T' x='24' y='-100'/>";
  for (const std::string road : {"WA", "AB", "BE", "NA", "AS", "MB", "BT"})
    plain.edges += "<edge id='" + road + "' from='" + road[0] + "' to='" + road[1] +
                   "' numLanes='1' speed='13'/>";
  return read_plain_net(plain);
}

// Buses stood between the boxes that one crossing of dual carriageways is drawn as, at red lights
// that no such crossing has, and shut the first.
TEST(InnerSignal, WhoGotGreenAtTheOuterOneClearsTheJunction) {
  RoadScene here(two_boxes());
  const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
  const PathLink link = here.path(own).links.at(1);
  ASSERT_GT(here.model.road.connection(link.connection).storage, 0.0);
  const std::size_t foe = here.add("car", {"MB", "BT"}, 0, 0);
  const PathLink their = here.path(foe).links.at(0);
  here.move(own, link.stop_line - 0.6 - 2.25);
  for (std::size_t i = 0; i < here.model.road.signals.size(); ++i)
    here.road.signal_states[i].assign(here.model.road.signals[i].size, 'r');
  here.road.signal_since.assign(here.model.road.signals.size(), 0.0);
  const Connection& green = here.model.road.connection(their.connection);
  here.road.signal_states[index_of(green.signal)][static_cast<std::size_t>(green.signal_link)] =
      'G';
  // who stands at its line, and has just got green, lets it go first
  here.set_speed(own, 1.0);
  here.move(foe, their.stop_line - 0.6 - 2.25);
  here.scene.time = 2.0;
  here.update(2);
  EXPECT_GT(here.context(own).allowed_speed, 0.3);
  EXPECT_LT(here.context(foe).allowed_speed, 0.3);
  EXPECT_EQ(here.context(foe).foe, here.scene.id[own].value);
  // later on it gives way
  here.scene.time = 30.0;
  here.set_speed(own, 0.0);
  here.set_speed(foe, 10.0);
  here.move(foe, their.stop_line - 20.0);
  here.update(2);
  EXPECT_LT(here.context(own).allowed_speed, 0.3);
  EXPECT_EQ(here.context(own).foe, here.scene.id[foe].value);
  EXPECT_GT(here.context(foe).allowed_speed, 9.0);
  // and goes where nobody comes
  here.move(foe, here.path(foe).arrival - 5.0);
  here.update(2);
  EXPECT_GT(here.context(own).allowed_speed, 0.3);
}

// Queues that waited for a light stood on the junction before it, across the ways of others.
TEST(JunctionsThatFollowClosely,
     WhoHasNoRoomBeforeALightWaitsForItBeforeTheJunctionThatItWouldBlock) {
  for (const bool cycle_path : {false, true}) {
    SCOPED_TRACE(cycle_path);
    RoadScene here(two_junctions(8, "traffic_light"));  // netconvert leaves nothing of AB
    const std::size_t own = here.add(cycle_path ? "bicycle" : "car", {"WA", "AB", "BE"}, 0, 0);
    const std::vector<PathLink> links = here.path(own).links;
    ASSERT_LT(links.at(1).stop_line - links.at(0).end, 1.0) << "no room between the two";
    if (cycle_path)
      here.model.road.lanes[index_of(here.model.road.connection(links[0].connection).to)].allowed =
          vehicle_class::kBicycle;
    here.move(own, links[0].halt - 0.6 - half_extent(here.scene, own, Vec2(1, 0)));
    const auto show = [&](char letter) {
      std::string& state = here.road.signal_states.at(0);
      state.assign(here.model.road.signals.at(0).size, letter);
    };
    for (const double waited : {0.0, 60.0}) {
      here.scene.held[own].standing = here.traffic.waiting_time[own] = waited;
      show('r');
      here.update();
      EXPECT_EQ(here.context(own).reason, LimitReason::Signal) << "after " << waited << " s";
      EXPECT_LT(here.context(own).allowed_speed, 0.3);
      show('G');
      here.update();
      EXPECT_GT(here.context(own).allowed_speed, 0.3) << "after " << waited << " s";
    }
  }
}

// Those who turn in right before a light queued for it twenty metres back, before those who come
// along the road that they turn into, and hardly got there while it was green.
TEST(JunctionsThatFollowClosely, WhoHoldsUpOnlyWhoJoinsGoesUpToTheLight) {
  for (const bool crossed : {false, true}) {
    SCOPED_TRACE(crossed);
    testing::PlainNet plain;
    plain.nodes =
        "<node id='W' x='-100' y='0'/><node id='A' x='0' y='0' type='priority'/>"
        "<node id='NA' x='30' y='100'/><node id='SA' x='0' y='-100'/>"
        "<node id='B' x='8' y='0' type='traffic_light'/><node id='E' x='120' y='0'/>"
        "<node id='N' x='8' y='-100'/><node id='S' x='8' y='100'/>";
    plain.edges =
        "<edge id='WA' from='W' to='A' priority='1' speed='13'/>"
        "<edge id='AB' from='A' to='B' priority='9' speed='13'/>"
        "<edge id='BE' from='B' to='E' priority='9' speed='13'/>"
        "<edge id='NAA' from='NA' to='A' priority='9' speed='13'/>"
        "<edge id='NB' from='N' to='B' speed='13'/><edge id='BS' from='B' to='S' speed='13'/>";
    if (crossed) plain.edges += "<edge id='ASA' from='A' to='SA' priority='1' speed='13'/>";
    RoadScene here(read_plain_net(plain));
    const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
    const std::vector<PathLink> links = here.path(own).links;
    ASSERT_LT(links.at(1).stop_line - links.at(0).end, 1.0) << "no room between the two";
    ASSERT_TRUE(has_crossing_traffic(here.model, links[0].connection)) << "somebody joins";
    std::string& state = here.road.signal_states.at(0);
    state.assign(here.model.road.signals.at(0).size, 'r');
    here.move(own, links[0].halt - 2.25 - 0.6);
    here.update();
    EXPECT_EQ(here.context(own).allowed_speed > 0.3, !crossed);
  }
}

// In Monaco whoever had a red light seven metres behind a zebra stood on the zebra, for 20 s each:
// there is room for a car behind it, but the line is drawn for the buses that turn in.
TEST(JunctionsThatFollowClosely, WhoseLineAtALightIsDrawnOnTheJunctionBeforeWaitsBeforeThatOne) {
  RoadScene here(two_junctions(18, "traffic_light"));
  const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
  const std::vector<PathLink> links = here.path(own).links;
  const double room = links.at(1).stop_line - links.at(0).end;
  ASSERT_GT(room, 6.0) << "for a car";
  ASSERT_LT(room, here.parameters.soon_way - 0.5);
  here.move(own, links[0].halt - 2.25 - 0.6);
  const auto waits = [&](char letter) {
    std::string& state = here.road.signal_states.at(0);
    state.assign(here.model.road.signals.at(0).size, letter);
    here.update();
    return here.context(own).reason == LimitReason::Signal && here.context(own).allowed_speed < 0.3;
  };
  EXPECT_FALSE(waits('r')) << "it goes up to the light";

  SweptWay swept;
  swept.foe = links[1].connection;
  swept.foe_sweeps = true;
  swept.begin = -room - 0.5;
  here.model.swept_ways[index_of(links[1].connection)].push_back(swept);
  for (const double waited : {0.0, 60.0}) {
    here.scene.held[own].standing = here.traffic.waiting_time[own] = waited;
    EXPECT_TRUE(waits('r')) << "after " << waited << " s";
    EXPECT_FALSE(waits('G')) << "after " << waited << " s";
  }
}

// a bus and a car had both waited on a junction for long, both tried, and met nose to nose
TEST_F(PriorityTest, OfTwoWhoHaveWaitedOnAJunctionForLongNobodyTriesWhileTheOtherDoes) {
  const std::size_t own = here_.add("car", {"SC", "CN"}, 0, 0.3);
  const PathLink& own_link = here_.path(own).links.front();
  here_.move(own, own_link.stop_line + 0.5);
  const std::size_t foe = here_.add("bus", {"WC", "CE"}, 0, 0.5, 0, -1, "WC_1");
  const PathLink& foe_link = here_.path(foe).links.front();
  here_.move(foe, foe_link.end - 3.0);
  here_.traffic.waiting_time[own] = here_.traffic.waiting_time[foe] = 12;
  here_.update();
  EXPECT_EQ(here_.context(own).foe, here_.scene.id[foe].value) << "it creeps on";
  here_.set_speed(foe, 0);
  here_.traffic.waiting_time[own] = here_.traffic.waiting_time[foe] = 12;
  here_.scene.context[foe] = {};
  here_.update();
  EXPECT_NE(here_.context(own).foe, here_.scene.id[foe].value) << "it stands, held by nothing";
}

// a motorcycle, a car, and a car behind the first stood for eight seconds, each for the next one
TEST_F(PriorityTest, ARingOnAJunctionDissolvesSoonerThanOthersWhoWait) {
  const std::size_t own = here_.add("car", {"SC", "CN"}, 0, 0);
  here_.move(own, here_.path(own).links.front().stop_line + 0.5);
  const std::size_t foe = here_.add("bus", {"WC", "CE"}, 0, 0, 0, -1, "WC_1");
  here_.move(foe, here_.path(foe).links.front().end - 3.0);
  const std::size_t third = here_.add("car", {"NC", "CS"}, 150, 0);
  auto is_held = [&](std::size_t third_waits_for, double waited) {
    const std::vector<std::size_t> chain = {own, foe, third, third_waits_for};
    for (std::size_t k = 0; k < 3; ++k) {
      here_.scene.context[chain[k]].active = true;
      here_.scene.context[chain[k]].reason = LimitReason::Yield;
      here_.scene.context[chain[k]].foe = here_.scene.id[chain[k + 1]].value;
    }
    here_.traffic.waiting_time = {waited + 1.0, waited, waited};
    here_.update();
    return here_.context(own).foe == here_.scene.id[foe].value;
  };
  EXPECT_FALSE(is_held(own, 4.0));
  EXPECT_TRUE(is_held(own, 2.0));
  EXPECT_TRUE(is_held(third, 4.0)) << "the third one waits for somebody else";
  EXPECT_FALSE(is_held(third, 11.0));
}

TEST_F(PriorityTest, NobodyWaitsForWhoIsHeldByBodiesAlone) {
  const std::size_t minor = add_at_line({"SC", "CN"});
  const std::size_t major = add_at_line({"WC", "CE"});
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield);
  here_.scene.held[major].blocked = 10;
  here_.scene.held[major].standing = 10;
  here_.update();
  EXPECT_NE(here_.context(minor).reason, LimitReason::Yield);
}

// a van that crept to and fro behind the tail of a queue held the whole road opposite for 129 s
TEST_F(PriorityTest, NobodyWaitsForWhoCreepsOutOfAWedge) {
  const std::size_t minor = add_at_line({"SC", "CN"});
  const std::size_t major = here_.add("car", {"WC", "CE"}, 0, 0.5);
  here_.move(major, here_.path(major).links.front().stop_line - 2.25 + 0.5);
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield);
  here_.scene.held[major].wedge_left = 10;
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield) << "it has just begun";
  here_.traffic.waiting_time[major] = 20;
  here_.update();
  EXPECT_NE(here_.context(minor).reason, LimitReason::Yield);
  const ConnectionId link = here_.path(major).links.front().connection;
  here_.model.road.connections[index_of(link)].signal = SignalId{0};
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield) << "at signals knots close by it";
  here_.model.road.connections[index_of(link)].signal = kNoSignal;
  here_.set_speed(major, 2.0);
  here_.update();
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield) << "it has got out";
}

// a queue that crept past the mouth of a side road, a metre at a time, held it for minutes: nobody
// in it ever stood for long enough to be crossed
TEST_F(PriorityTest, WhoHasWaitedCrossesAQueueThatCreepsUpBeforeTheJunction) {
  const std::size_t minor = add_at_line({"SC", "CN"});
  const std::size_t head = here_.add("motorcycle", {"WC", "CE"}, 0, 0);
  const double line = here_.path(head).links.front().stop_line;
  here_.move(head, line - 1.1 - 0.6);
  const std::size_t next = here_.add("car", {"WC", "CE"}, 0, 1.0);
  here_.move(next, line - 0.6 - 2.2 - 2.0 - 2.25);
  const auto update_after = [&](double waited) {
    here_.traffic.waiting_time[minor] = waited;
    here_.scene.context[head].reason = LimitReason::BlockedJunction;
    here_.scene.context[head].foe = -1;
    here_.scene.context[next].reason = LimitReason::Leader;
    here_.scene.context[next].foe = here_.scene.id[head].value;
    here_.update();
  };
  here_.update();
  update_after(5);
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(minor).foe, here_.scene.id[next].value);
  update_after(25);
  EXPECT_NE(here_.context(minor).reason, LimitReason::Yield);
  Connection& link =
      here_.model.road.connections[index_of(here_.path(next).links.front().connection)];
  link.signal = SignalId{0};
  update_after(20);
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield) << "at signals knots close by it";
  link.signal = kNoSignal;
  here_.set_speed(head, 2.0);
  update_after(20);
  EXPECT_EQ(here_.context(minor).reason, LimitReason::Yield) << "the queue moves";
}

// into a full road cars came up to the line one by one, each to halt there, and who waited in the
// side road gave way to every one of them
TEST_F(PriorityTest, WhoComesUpToItsLineToHaltThereIsNotWaitedFor) {
  const std::size_t minor = add_at_line({"SC", "CN"});
  const std::size_t major = here_.add("car", {"WC", "CE"}, 0, 0);
  const double line = here_.path(major).links.front().stop_line;
  const auto update_with = [&](double speed, LimitReason reason, double to_halt) {
    here_.move(major, line - 2.25 - 8.0);
    here_.set_speed(major, speed);
    here_.scene.context[major].reason = reason;
    here_.scene.context[major].to_halt = to_halt;
    here_.update();
    return here_.context(minor).reason;
  };
  const double nowhere = std::numeric_limits<double>::infinity();
  here_.update();
  EXPECT_EQ(update_with(3, LimitReason::None, nowhere), LimitReason::Yield);
  EXPECT_NE(update_with(3, LimitReason::BlockedJunction, 7.4), LimitReason::Yield);
  EXPECT_NE(update_with(3, LimitReason::LetsIn, 7.4), LimitReason::Yield);
  EXPECT_EQ(update_with(3, LimitReason::Leader, 7.4), LimitReason::Yield) << "who may drive on";
  EXPECT_EQ(update_with(3, LimitReason::BlockedJunction, 30), LimitReason::Yield)
      << "it halts behind the junction";
  EXPECT_EQ(update_with(9, LimitReason::BlockedJunction, 7.4), LimitReason::Yield)
      << "it can hardly halt";
}

// who rolls over the junction and halts there is not gone when its speed says so
TEST_F(PriorityTest, NobodySetsOutForAPlaceInWhichSomebodyWillHalt) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 10, 0, -1, "WC_0");
  here_.move(own, here_.path(own).links.front().stop_line - 35);
  const std::size_t foe = here_.add("car", {"SC", "CN"}, 0, 7);
  here_.move(foe, here_.path(foe).line.project(Vec2(0, -4)).along);
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::Yield) << "it will be gone";
  here_.scene.context[foe].to_halt = 2.5;
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(own).foe, here_.scene.id[foe].value);
}

// a left turn waits for oncoming traffic on the junction, but not where others are about to cross
TEST_F(PriorityTest, WhoWaitsOnTheJunctionLeavesTheWaysOfOthersFree) {
  const std::size_t own = here_.add("car", {"WC", "CN"}, 0, 2);
  here_.move(own, here_.path(own).links.front().stop_line + 0.5 - 2.25);
  const std::size_t oncoming = here_.add("car", {"EC", "CW"}, 0, 12);
  here_.move(oncoming, here_.path(oncoming).links.front().stop_line - 15);
  here_.update();
  ASSERT_EQ(here_.context(own).reason, LimitReason::Yield);
  const double alone = here_.context(own).to_halt;
  const std::size_t crossing = here_.add("bus", {"NC", "CS"}, 0, 6);
  here_.move(crossing, here_.path(crossing).links.front().stop_line - 12);
  here_.update();
  ASSERT_EQ(here_.context(own).foe, here_.scene.id[oncoming].value);
  EXPECT_LT(here_.context(own).to_halt, alone - 1.0);
  // not for ever
  here_.traffic.waiting_time[own] = 30.0;
  here_.update();
  EXPECT_EQ(here_.context(own).to_halt, alone);
}

// a bus came to rest half a metre beyond its place, took itself for being past it, where who comes
// first goes first, and turned before those who came towards it
TEST_F(PriorityTest, WhoRollsOutBeyondItsPlaceOnTheJunctionStillWaitsThere) {
  const std::size_t own = here_.add("car", {"WC", "CN"}, 0, 0);
  const std::size_t oncoming = here_.add("car", {"EC", "CW"}, 0, 10);
  const PathLink& link = here_.path(own).links.front();
  here_.move(oncoming, here_.path(oncoming).links.front().stop_line - 15);
  const double place = std::min(link.inside, zone_of(own, oncoming)) - 0.3;
  ASSERT_GT(place, link.stop_line + 1.5) << "there is a place to wait on the junction";
  for (const double beyond : {0.0, 0.25, 0.5}) {
    here_.move(own, place + beyond - 2.25);
    here_.update();
    EXPECT_EQ(here_.context(own).reason, LimitReason::Yield) << beyond;
  }
}

// a motorcycle that had come along beside a queue waited on a junction in the way of a truck that
// turned there
TEST_F(PriorityTest, WhoRidesBesideTheMiddleOfItsLaneWaitsForLongBodiesBeforeTheJunction) {
  for (const std::string oncoming_type : {"car", "bus"}) {
    RoadScene here{net()};
    const std::size_t own = here.add("motorcycle", {"WC", "CN"}, 0, 3);
    const std::size_t oncoming = here.add(oncoming_type, {"EC", "CW"}, 0, 10);
    here.move(oncoming, here.path(oncoming).links.front().stop_line - 15);
    for (const double aside : {-1.0, 0.0, 1.0}) {
      here.move(own, here.path(own).links.front().stop_line - 6, aside);
      here.traffic.passing_offset[own] = aside;
      here.update();
      ASSERT_EQ(here.context(own).foe, here.scene.id[oncoming].value) << aside;
      const bool on_junction = here.context(own).to_halt > 6.0;
      EXPECT_EQ(on_junction, oncoming_type == "car" || aside == 0.0) << oncoming_type << aside;
    }
  }
}

// where they come one after the other, left turns waited for a gap for 90 s
class LongStand : public PriorityTest {
 protected:
  /// Over the major road, before which it has stood for so long [s].
  void stand(double time) {
    here_.traffic.halted_for[own_] = here_.path(own_).links.front().connection;
    here_.traffic.halted_at[own_] = here_.scene.time - time;
    here_.scene.context[own_].reason = LimitReason::Yield;
  }
  /// Somebody on the major road comes, so far before its line.
  void come(double way, double speed = 12) {
    here_.set_speed(driver_, speed);
    here_.move(driver_, here_.path(driver_).links.front().stop_line - 2.25 - way);
  }
  bool waits(std::size_t row, std::size_t foe) const {
    return here_.context(row).foe == here_.scene.id[foe].value;
  }
  std::size_t own_ = add_at_line({"SC", "CN"});
  std::size_t driver_ = here_.add("car", {"WC", "CE"}, 0, 12, 0, -1, "WC_0");
};

TEST_F(LongStand, NosesOutBeforeWhoHaltsForItAtEase) {
  for (const double way : {40.0, 25.0}) {
    for (const double time : {40.0, 60.0}) {
      come(way);
      stand(time);
      here_.update();
      const bool goes = way == 40.0 && time == 60.0;
      EXPECT_NE(waits(own_, driver_), goes) << way << " m, " << time << " s";
      EXPECT_EQ(waits(driver_, own_), goes) << way << " m, " << time << " s";
    }
  }
}

TEST_F(LongStand, NobodyWaitsForItForLongNorWhoHasStoodForAsLong) {
  come(0.5, 0);
  stand(60);
  here_.update();
  EXPECT_TRUE(waits(driver_, own_));
  here_.traffic.waiting_time[driver_] = 15;
  here_.update();
  EXPECT_FALSE(waits(driver_, own_)) << "it has waited for it long enough";
  here_.traffic.waiting_time[driver_] = 0;
  here_.traffic.halted_for[driver_] = here_.path(driver_).links.front().connection;
  here_.traffic.halted_at[driver_] = here_.scene.time - 60;
  here_.update();
  EXPECT_FALSE(waits(driver_, own_)) << "of two that nose out one would wait for the other";
}

// it halted on the junction before each lane for somebody who stood there for it
TEST_F(LongStand, GoesBeforeWhoStandsAndWaitsForIt) {
  come(0.5, 0);
  stand(60);
  here_.traffic.waiting_time[driver_] = 5;
  here_.scene.context[driver_].reason = LimitReason::Yield;
  here_.scene.context[driver_].foe = static_cast<std::int64_t>(here_.scene.id[own_].value);
  here_.update();
  EXPECT_FALSE(waits(own_, driver_));
  EXPECT_TRUE(waits(driver_, own_));
}

TEST_F(LongStand, CountsOnTheJunctionToo) {
  const std::size_t turning = here_.add("car", {"WC", "CN"}, 0, 0);
  const PathLink link = here_.path(turning).links.front();
  here_.scene.held[turning].standing = 1.0;
  here_.move(turning, link.inside - 1.0 - 2.25);
  here_.update();
  EXPECT_EQ(here_.traffic.halted_for[turning], link.connection);
}

// two that took each other for somebody who stands met nose to nose
TEST_F(PriorityTest, WhoCreepsOnTheJunctionIsNotTakenForSomebodyWhoStands) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(own, here_.path(own).links.front().stop_line - 1.0);
  const std::size_t foe = here_.add("car", {"SC", "CN"}, 0, 0);
  // so close before the own way that it can't halt there any more
  here_.move(foe, zone_of(foe, own) - 2.25 - 0.02);
  auto decide = [&](double speed) {
    here_.set_speed(foe, speed);
    here_.traffic.waiting_time[own] = here_.traffic.waiting_time[foe] = 6.0;
    here_.scene.context[foe].reason = LimitReason::Yield;
    here_.scene.context[foe].foe = 77;
    here_.update();
    return here_.context(own).reason;
  };
  EXPECT_NE(decide(0.0), LimitReason::Yield);
  EXPECT_EQ(decide(0.4), LimitReason::Yield);
}

// in a mini-roundabout each let those go first who waited for somebody else, for four seconds each
TEST_F(PriorityTest, WhoWaitsForAThirdOneIsPassedAfterALook) {
  const std::size_t own = add_at_line({"SC", "CN"});
  const std::size_t foe = add_at_line({"WC", "CE"}, "WC_0");
  auto is_held = [&](double own_wait, double their_wait) {
    here_.traffic.waiting_time[own] = own_wait;
    here_.traffic.waiting_time[foe] = their_wait;
    here_.scene.context[foe].reason = LimitReason::Yield;
    here_.scene.context[foe].foe = 77;
    here_.update();
    return here_.context(own).reason == LimitReason::Yield;
  };
  EXPECT_FALSE(is_held(2.5, 6.0));
  EXPECT_TRUE(is_held(1.0, 6.0)) << "it has just come";
  EXPECT_TRUE(is_held(2.5, 3.0)) << "the other may be about to go";
}

// a bus that had rolled beyond its place amid a junction set out before a lorry at 10 m/s, since it
// was the first to get into its way; they met nose to nose, and 47 stood behind them
TEST_F(PriorityTest, WhoHasToWaitBeyondItsPlaceOnTheJunctionCutsNobodyOff) {
  const std::size_t own = here_.add("car", {"WC", "CN"}, 0, 0);
  const std::size_t oncoming = here_.add("car", {"EC", "CW"}, 0, 0);
  here_.move(own, zone_of(own, oncoming) - 0.35 - 2.25);
  ASSERT_GT(zone_of(own, oncoming) - 0.35, here_.path(own).links.front().inside + 0.3)
      << "past its place";
  here_.move(oncoming, zone_of(oncoming, own) - 20 - 2.25);
  for (const double speed : {4.0, 12.0}) {
    here_.set_speed(oncoming, speed);
    here_.update();
    EXPECT_EQ(here_.context(own).reason == LimitReason::Yield, speed > 10) << speed;
  }
}

TEST_F(PriorityTest, WhoHasBackedOutLetsTheOthersPast) {
  const std::size_t own = add_at_line({"WC", "CE"});
  const std::size_t other = here_.add("car", {"SC", "CN"}, 0, 0);
  here_.move(other, here_.path(other).line.project(Vec2(0, -5)).along);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Yield);
  here_.traffic.gives_way_left[other] = 5;
  here_.update(2);
  EXPECT_NE(here_.context(own).reason, LimitReason::Yield);
}

TEST_F(PriorityTest, AStopSignIsHaltedAt) {
  RoadNetwork network = net();
  for (Connection& connection : network.connections)
    if (connection.priority == LinkPriority::Minor) connection.priority = LinkPriority::Stop;
  RoadScene here(network);
  const std::size_t own = here.add("car", {"SC", "CN"}, 0, 8);
  const double line = here.path(own).links.front().stop_line;
  here.move(own, line - 20);
  here.update();
  EXPECT_EQ(here.context(own).reason, LimitReason::Yield);
  // having stood at the line, it goes
  here.move(own, line - 2.25 - 0.7);
  here.set_speed(own, 0);
  here.scene.held[own].standing = 1.0;
  here.update();
  EXPECT_NE(here.context(own).reason, LimitReason::Yield);
}

// --- going at red: the crossroads with signals, where the south-north road shows red

class RedLightRunning : public ::testing::Test {
 protected:
  RedLightRunning() {
    show_across_green(here_, 'r');
    own_ = here_.add("motorcycle", {"SC", "CN"}, 0, 0);
    here_.scene.manners[own_].key = 1;
    here_.move(own_, here_.path(own_).links.front().halt - 1.1 - 0.7);
    here_.scene.held[own_].standing = 1.0;
  }
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("traffic_light"));
    return network;
  }
  void set_rate(double rate) {
    for (AgentType& type : here_.model.types) type.compliance.red_light_running = rate;
  }
  RoadScene here_{net()};
  std::size_t own_ = 0;
};

// a bus that was left on the junction stood in everybody's way for the whole of the next green
TEST_F(RedLightRunning, WhoIsLeftOnTheJunctionLeavesItBeforeOthersCome) {
  const std::size_t left = here_.add("bus", {"SC", "CN"}, 0, 0);
  here_.move(left, here_.path(left).links.front().stop_line + 0.5 - 6.0);
  const std::size_t green = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(green, here_.path(green).links.front().stop_line - 2.25 - 0.7);
  for (const std::size_t row : {left, green}) {
    here_.scene.context[row].reason = LimitReason::Yield;
    here_.scene.context[row].foe = here_.scene.id[row == left ? green : left].value;
    here_.traffic.waiting_time[row] = 30;
  }
  here_.road.signal_since.assign(here_.road.signal_states.size(), here_.scene.time - 2.0);
  here_.update();
  EXPECT_EQ(here_.context(green).foe, here_.scene.id[left].value);
  EXPECT_NE(here_.context(left).foe, here_.scene.id[green].value);
  // but not for ever
  here_.road.signal_since.assign(here_.road.signal_states.size(), here_.scene.time - 25.0);
  here_.scene.context[left].reason = LimitReason::Leader;
  here_.update();
  EXPECT_NE(here_.context(green).foe, here_.scene.id[left].value);
}

TEST_F(RedLightRunning, WhoKeepsTheRuleStaysThoughTheWayIsFree) {
  here_.update();
  EXPECT_EQ(here_.context(own_).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own_).allowed_speed, 0.1);
}

TEST_F(RedLightRunning, WhoDoesNotGoesWhereTheWayIsFree) {
  set_rate(1.0);
  here_.update();
  EXPECT_EQ(here_.context(own_).reason, LimitReason::None);
  EXPECT_GT(here_.context(own_).allowed_speed, 0.1);
}

TEST_F(RedLightRunning, ItHaltsFirst) {
  set_rate(1.0);
  here_.move(own_, here_.path(own_).links.front().halt - 15);
  here_.set_speed(own_, 8);
  here_.scene.held[own_].standing = 0.0;
  here_.update();
  EXPECT_EQ(here_.context(own_).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own_).allowed_speed, 8.0);
}

TEST_F(RedLightRunning, ItWaitsForWhoHasGreen) {
  set_rate(1.0);
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 165, 12);
  here_.update();
  EXPECT_EQ(here_.context(own_).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(own_).foe, here_.scene.id[foe].value);
  EXPECT_LT(here_.context(own_).allowed_speed, 0.1);
  EXPECT_GT(here_.context(foe).allowed_speed, 12.0);
}

TEST_F(RedLightRunning, ItWaitsForWhoGoesAtRedToo) {
  set_rate(1.0);
  const std::size_t foe = here_.add("car", {"NC", "CE"}, 0, 4);
  here_.scene.manners[foe].key = 2;
  here_.move(foe, here_.path(foe).links.front().halt - 6);
  here_.update();
  EXPECT_EQ(here_.context(own_).foe, here_.scene.id[foe].value);
}

// --- crossings: drivers yield on the crossroads with sidewalks

class CrossingTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = [] {
      testing::PlainNet plain = crossroads("priority", {"--sidewalks.guess", "--crossings.guess"});
      return read_plain_net(plain);
    }();
    return network;
  }
  /// Makes a crossing one on which people go first.
  void give_priority(ConnectionId crossing) {
    for (auto& zones : here_.model.conflicts)
      for (ConflictZone& zone : zones)
        if (zone.foe == crossing) zone.yields = true;
    for (ConflictZone& zone : here_.model.conflicts[index_of(crossing)]) zone.yields = false;
  }
  RoadScene here_{net()};
};

// The crossing over the west arm runs from north (y = 6.4) to south: its own direction is that of a
// walk from CW to WC.
TEST_F(CrossingTest, DriversWaitForSomebodyOnTheirSideOfTheRoad) {
  const std::size_t walker = here_.add("pedestrian", {"CW", "WC"}, 0, 1.3, 5, 195);
  ASSERT_EQ(here_.path(walker).links.size(), 1u);
  const PathLink& walk = here_.path(walker).links.at(0);
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 6, 0, -1, "WC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 2.25 - 9);
  here_.move(walker, walk.stop_line + 10);
  here_.update();
  EXPECT_EQ(here_.context(driver).foe, here_.scene.id[walker].value);
  EXPECT_LT(here_.context(driver).allowed_speed, 6.0);
  // on the other half of the road it holds nobody yet
  here_.move(walker, walk.stop_line + 3);
  here_.update();
  EXPECT_EQ(here_.context(driver).reason, LimitReason::None);
}

TEST_F(CrossingTest, ADriverWhoDoesNotYieldIsLetPastAndStopsForWhoIsOnTheCrossing) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 1.3, 195, 5);
  ASSERT_EQ(here_.path(walker).links.size(), 1u);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 6, 0, -1, "WC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 2.25 - 9);
  here_.move(walker, kerb - 1.2);
  give_priority(here_.path(walker).links.at(0).connection);
  here_.update();
  EXPECT_EQ(here_.context(driver).foe, here_.scene.id[walker].value);
  EXPECT_EQ(here_.context(walker).reason, LimitReason::None);
  // it doesn't yield: whoever waits sees it and lets it past
  for (AgentType& type : here_.model.types) type.compliance.yielding_rate = 0.0;
  here_.scene.manners[driver].key = 1;
  here_.update();
  EXPECT_EQ(here_.context(driver).reason, LimitReason::None);
  EXPECT_EQ(here_.context(walker).foe, here_.scene.id[driver].value);
  EXPECT_LT(here_.context(walker).allowed_speed, 1.0);
  // whoever is on the crossing is waited for by everybody
  here_.move(walker, kerb + 1.0);
  here_.update();
  EXPECT_EQ(here_.context(driver).foe, here_.scene.id[walker].value);
  EXPECT_LT(here_.context(driver).allowed_speed, 6.0);
}

// a driver on the junction waited for 40 s for somebody who shuffled before the truck that stood
// across the crossing, and that truck waited for the driver
TEST_F(CrossingTest, NobodyWaitsForWhoShufflesBeforeWhatShutsTheCrossing) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 2.25 - 0.6);
  here_.move(walker, kerb - 0.3);
  give_priority(here_.path(walker).links.at(0).connection);
  here_.update();
  EXPECT_EQ(here_.context(driver).foe, here_.scene.id[walker].value);
  here_.traffic.waiting_time[walker] = 12;
  here_.update();
  EXPECT_EQ(here_.context(driver).reason, LimitReason::None);
}

//     |  crossing  |
//     |_____^______|      the way turns left onto it: who walks to its left is on the crossing
//   ------> '             before its place on the path is
TEST_F(CrossingTest, WhoWaitsInsideTheCornerWaitsBesideTheCrossing) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.5, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 6, 0, -1, "WC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 2.25 - 9);
  give_priority(here_.path(walker).links.at(0).connection);
  for (AgentType& type : here_.model.types) type.compliance.yielding_rate = 0.0;
  here_.scene.manners[driver].key = 1;
  auto ahead = [&](double offset) {
    here_.move(walker, kerb - 1.2, offset);
    here_.update();
    EXPECT_EQ(here_.context(walker).foe, here_.scene.id[driver].value);
    const Vec2 way = here_.context(walker).sub_goal - here_.scene.position[walker];
    return way.dot(here_.path(walker).line.direction_at(kerb - 1.2));
  };
  EXPECT_GT(ahead(0.0), 0.0);
  EXPECT_LT(ahead(0.8), 0.0);  // steps back
}

TEST_F(CrossingTest, WhoHaltsForSomebodyBrakesNoHarderForAvoidance) {
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 11, 0, -1, "WC_1");
  const double line = here_.path(driver).links.at(0).stop_line;
  here_.move(driver, line - 2.25 - 17);
  const std::size_t walker = here_.add("pedestrian", {"CW", "WC"}, 0, 1.3, 5, 195);
  here_.set_speed(walker, 0.5);
  here_.move(walker, here_.path(walker).links.at(0).stop_line + 10);
  here_.update();
  ASSERT_EQ(here_.context(driver).foe, here_.scene.id[walker].value);
  EXPECT_NEAR(here_.context(driver).to_halt, 17 - TrafficParameters{}.stop_margin, 0.1);
  auto chosen = [&](std::size_t row) {
    Workspace work;
    return gamma_velocity(here_.model, here_.scene, here_.geometry, row, here_.scene.behavior[row],
                          work);
  };
  EXPECT_NEAR(chosen(driver).norm(), here_.context(driver).allowed_speed, 0.01);
  // not counted on, its halt would be too late
  here_.scene.context[driver].to_halt = 1e9;
  EXPECT_LT(chosen(driver).norm(), here_.context(driver).allowed_speed - 0.3);
}

class WalkersAtRed : public ::testing::Test {
 protected:
  WalkersAtRed() {
    for (std::string& states : here_.road.signal_states) states = std::string(100, 'r');
  }
  void put(std::size_t walker, double front) {
    here_.move(walker, front - 0.2);
    here_.update();
  }
  /// Does somebody aim back at the kerb whose front is so far past it [m]?
  bool steps_back(std::size_t walker, double front) {
    const double kerb = here_.path(walker).links.at(0).stop_line;
    put(walker, kerb + front);
    const Vec2 way = here_.context(walker).sub_goal - here_.scene.position[walker];
    return way.dot(here_.path(walker).line.direction_at(kerb)) < 0.0;
  }
  RoadScene here_{
      read_plain_net(crossroads("traffic_light", {"--sidewalks.guess", "--crossings.guess"}))};
};

TEST_F(WalkersAtRed, WhoIsAtTheKerbHaltsThoughNotAtEaseAndWhoIsOnTheCrossingGoesOn) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 1.4, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  auto is_held = [&](double front) {
    put(walker, kerb + front);
    return here_.context(walker).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(is_held(-1.0));
  EXPECT_TRUE(is_held(-0.1));
  EXPECT_TRUE(is_held(0.15));  // a foot on it
  EXPECT_TRUE(is_held(0.45));  // at full pace
  EXPECT_FALSE(is_held(1.0));
}

// before a bus that stood on the crossing somebody found its way round it at red
TEST_F(WalkersAtRed, WhoHasHardlySteppedOnAndCrawlsWaits) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.3, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  put(walker, kerb + 0.45);
  EXPECT_EQ(here_.context(walker).reason, LimitReason::Signal);
  here_.scene.context[walker] = {};
  put(walker, kerb + 0.75);
  EXPECT_NE(here_.context(walker).reason, LimitReason::Signal);
}

// in a crowd at the kerb: who was pressed onto the road took itself for somebody who crosses
TEST_F(WalkersAtRed, WhoWaitsForTheLightAndIsPressedOnStepsBack) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  EXPECT_FALSE(steps_back(walker, 2.0)) << "it crosses";
  steps_back(walker, -0.1);
  ASSERT_EQ(here_.context(walker).reason, LimitReason::Signal);
  EXPECT_TRUE(steps_back(walker, 2.0)) << "it waited";
}

// it turned round half a metre after the light had changed, and others who came back behind it
// pressed it on over the crossing
TEST_F(WalkersAtRed, WhoStepsBackGoesNoFurtherOn) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  const Vec2 across = here_.path(walker).line.direction_at(kerb);
  steps_back(walker, -0.1);
  ASSERT_TRUE(steps_back(walker, 1.5));
  const auto admits = [&](const Vec2& velocity) {
    ConstraintSet set;
    append_contextual_constraints(here_.model, here_.scene, walker, set);
    return std::all_of(set.planes.begin(), set.planes.end(),
                       [&](const HalfPlane& plane) { return slack(plane, velocity) > -1e-9; });
  };
  EXPECT_FALSE(admits(0.1 * across));
  EXPECT_TRUE(admits(-0.3 * across));
  EXPECT_TRUE(admits(Vec2::Zero()));
}

// at green a queue stood over the crossing: it shuffled about there until the light was red, and
// then on to and fro
TEST_F(WalkersAtRed, WhoSetOutAndGotNoFurtherStepsBack) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  here_.traffic.waiting_time[walker] = 5.0;
  EXPECT_TRUE(steps_back(walker, 2.0));
  EXPECT_EQ(here_.context(walker).reason, LimitReason::Signal);
  here_.scene.context[walker] = {};
  EXPECT_FALSE(steps_back(walker, 4.0)) << "amid the road it goes on";
  EXPECT_NE(here_.context(walker).reason, LimitReason::Signal);
}

// in the crowd of a corner somebody was pressed onto the crossing to which its way leads in the end
TEST_F(WalkersAtRed, WhoseWayToItsCrossingIsLongIsKeptOffIt) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  Path path = here_.path(walker);
  const double kerb = path.links.at(0).stop_line, turn = kerb - 0.5, round = 6.0;
  const Vec2 across = path.line.direction_at(kerb);
  // before the kerb it goes three metres aside and comes back
  std::vector<Vec2> points;
  append_span(path.line, 0.0, turn, points);
  points.push_back(path.line.point_at(turn) + 0.5 * round * left_of(across));
  append_span(path.line, turn, path.line.length(), points);
  path.line = Polyline(points);
  for (PathStretch& stretch : path.stretches) {
    if (stretch.from > turn) stretch.from += round;
    if (stretch.to > turn) stretch.to += round;
  }
  for (PathLink& link : path.links)
    for (double* place : {&link.stop_line, &link.halt, &link.inside, &link.end}) *place += round;
  here_.road.paths[static_cast<std::size_t>(here_.scene.path[walker])] =
      std::make_shared<const Path>(path);
  put(walker, turn - 0.1);
  ASSERT_NE(here_.context(walker).reason, LimitReason::Signal) << "not yet";
  EXPECT_GT(here_.context(walker).to_red[0].dot(across), 0.0);
  // on its rim when the light changed: no further on
  here_.scene.position[walker] = path.line.point_at(turn) + 0.8 * across + 0.9 * left_of(across);
  here_.update();
  EXPECT_GT(here_.context(walker).to_red[0].dot(across), 0.0);
}

// pressed off the crossing again, it shuffled onto it round somebody who stood behind it
TEST_F(WalkersAtRed, WhoWaitsBesideItsCrossingIsKeptOffIt) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  const Vec2 across = here_.path(walker).line.direction_at(kerb);
  auto admits = [&](const Vec2& velocity) {
    ConstraintSet set;
    append_contextual_constraints(here_.model, here_.scene, walker, set);
    return std::all_of(set.planes.begin(), set.planes.end(),
                       [&](const HalfPlane& plane) { return slack(plane, velocity) > -1e-9; });
  };
  // beside it on its first metre, and before it
  const Vec2 aside = left_of(across);
  here_.move(walker, kerb + 0.3);
  here_.scene.position[walker] += 2.5 * aside;
  here_.update();
  ASSERT_EQ(here_.context(walker).reason, LimitReason::Signal);
  EXPECT_NEAR(here_.context(walker).to_red[0].dot(-aside), 0.5 - 0.2, 0.1);
  EXPECT_FALSE(admits(-0.9 * aside));
  EXPECT_TRUE(admits(-0.3 * aside));
  // at its edge: at 2 cm/s one was on it after 16 s
  here_.move(walker, kerb + 0.3);
  here_.scene.position[walker] += (2.5 - here_.context(walker).to_red[0].norm() + 0.05) * aside;
  here_.update();
  here_.scene.position[walker] += here_.context(walker).to_red[0];
  here_.update();
  EXPECT_FALSE(admits(-0.01 * aside));
  EXPECT_TRUE(admits(Vec2::Zero()));
  put(walker, kerb - 0.2);
  EXPECT_GT(here_.context(walker).to_red[0].dot(across), 0.0);
  for (std::string& states : here_.road.signal_states) states = std::string(100, 'G');
  put(walker, kerb - 0.2);
  EXPECT_TRUE(here_.context(walker).to_red[0].isZero());
}

// a lorry stood a whole green before somebody who waited on an island of 0.6 m with a foot on its
// side
// it had crossed, met a crowd at the other kerb, and went round that over the crossing again
TEST_F(WalkersAtRed, WhoHasCrossedIsKeptOffTheCrossingBehindIt) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.3, 195, 5);
  const Path& path = here_.path(walker);
  const auto crossing =
      std::find_if(path.stretches.begin(), path.stretches.end(), [&](const PathStretch& stretch) {
        return here_.model.road.lane(stretch.lane).kind == LaneKind::Crossing;
      });
  ASSERT_NE(crossing, path.stretches.end());
  const Lane& lane = here_.model.road.lane(crossing->lane);
  const Vec2 across = path.line.direction_at(0.5 * (crossing->from + crossing->to));
  const double half = 0.5 * lane.centerline.length();
  const Vec2 far_end = lane.centerline.point_at(half) + half * across;
  here_.move(walker, crossing->to + 0.6);
  here_.scene.position[walker] = far_end + 0.6 * across;
  here_.update();
  EXPECT_LT((here_.context(walker).to_red[0] + 0.4 * across).norm(), 0.15);
  const auto is_kept_off_at = [&](double before) {
    here_.move(walker, crossing->to - before);
    here_.scene.position[walker] = far_end - before * across;
    here_.update();
    const auto& ways = here_.context(walker).to_red;
    return std::any_of(ways.begin(), ways.end(),
                       [&](const Vec2& way) { return way.dot(across) < 0.0; });
  };
  EXPECT_FALSE(is_kept_off_at(1.5)) << "it is on it";
  EXPECT_TRUE(is_kept_off_at(0.6)) << "about to leave it: one went back onto it round a bicycle";
}

TEST_F(WalkersAtRed, OnANarrowIslandPeopleStandInItsMiddle) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.3, 195, 5);
  Path path = here_.path(walker);
  const PathLink whole = path.links.at(0);
  PathLink first = whole, second = whole;
  const double island = 0.5 * (whole.stop_line + whole.end);
  first.end = island;
  second.stop_line = second.halt = island + 0.6;
  path.links = {first, second};
  here_.road.paths[static_cast<std::size_t>(here_.scene.path[walker])] =
      std::make_shared<const Path>(path);
  // on its way to it, there, and a little too far
  auto is_held = [&](double middle) {
    put(walker, island + middle + 0.2);
    EXPECT_EQ(here_.context(walker).reason, LimitReason::Signal);
    return here_.context(walker).allowed_speed < 0.1;
  };
  EXPECT_FALSE(is_held(-0.2));
  EXPECT_TRUE(is_held(0.3));
  EXPECT_TRUE(is_held(0.4));
}

// a driver with the right of way braked with 8 m/s2 for who had come out over the line when it got
// there, not before
TEST_F(PriorityTest, WhoComesOutFirstIsSeenBeforeItIsInTheWay) {
  const std::size_t minor = here_.add("car", {"NC", "CE"}, 0, 2.5);
  const std::size_t major = here_.add("car", {"WC", "CE"}, 0, 13, 0, -1, "WC_1");
  here_.move(major, here_.path(major).links.front().stop_line - 30);
  auto held_with_front_at = [&](double past) {
    here_.move(minor, here_.path(minor).links.front().stop_line + past - 2.25);
    here_.update();
    return here_.context(major).foe == static_cast<std::int64_t>(here_.scene.id[minor].value);
  };
  EXPECT_FALSE(held_with_front_at(-0.5)) << "it waits yet";
  EXPECT_TRUE(held_with_front_at(5.0));
}

// who had the right of way and was on the junction already slowed down for everybody who waited
// there to turn left, because that one would have got to the place first
TEST_F(PriorityTest, WhoWaitsOnTheJunctionSlowsNobodyDown) {
  const std::size_t turning = here_.add("car", {"WC", "CN"}, 0, 0);
  const PathLink& link = here_.path(turning).links.front();
  ASSERT_GT(link.inside, link.stop_line + 1.0);
  const std::size_t oncoming = here_.add("bus", {"EC", "CW"}, 0, 0.4);
  here_.move(oncoming, here_.path(oncoming).links.front().stop_line + 0.5 - 6.0);
  auto holds_with_front_at = [&](double along, double speed) {
    here_.move(turning, along - 2.25);
    here_.set_speed(turning, speed);
    here_.scene.context[turning].reason = LimitReason::Yield;
    here_.scene.context[turning].foe = 99;  // somebody before
    here_.update();
    return here_.context(oncoming).foe == static_cast<std::int64_t>(here_.scene.id[turning].value);
  };
  const double zone = zone_of(turning, oncoming);
  EXPECT_FALSE(holds_with_front_at(link.inside - 0.3, 0));
  EXPECT_FALSE(holds_with_front_at(link.inside + 0.5, 0.5)) << "it has crept on, but can halt yet";
  EXPECT_TRUE(holds_with_front_at(zone - 0.5, 4)) << "it has set out";
}

// a lorry drove on towards a van in its way, because it was too late to halt before the place where
// their ways cross, and met it nose to nose
TEST_F(PriorityTest, NobodyDrivesOnTowardsWhoIsInTheWay) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 6, 0, -1, "WC_0");
  const std::size_t foe = here_.add("truck", {"SC", "CN"}, 0, 0);
  here_.move(own, zone_of(own, foe) - 2.25 - 1.5);
  here_.move(foe, zone_of(foe, own) + 2.0);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(own).foe, static_cast<std::int64_t>(here_.scene.id[foe].value));
  EXPECT_LT(here_.context(own).allowed_speed, 5.8) << "it brakes hard";
}

TEST_F(PriorityTest, WhoTurnsIntoTheOtherLaneHoldsNobodyUp) {
  // it heads for the eastbound car's lane now, but its way bends before
  const std::size_t turning = here_.add("car", {"NC", "CW"}, 0, 4);
  const double line = here_.path(turning).links.front().stop_line;
  here_.move(turning, line + 2.5);
  const std::size_t oncoming = here_.add("car", {"WC", "CE"}, 0, 13, 0, -1, "WC_1");
  here_.move(oncoming, here_.path(oncoming).links.front().stop_line - 10);
  here_.update();
  Workspace work;
  const Vec2 chosen = gamma_velocity(here_.model, here_.scene, here_.geometry, oncoming,
                                     here_.scene.behavior[oncoming], work);
  EXPECT_GT(chosen.norm(), 12.8);
}

// where vehicles go first and come without end, somebody on foot stood at the kerb for minutes
TEST_F(CrossingTest, WhoHasWaitedForLongStepsOutBeforeWhoHaltsForItAtEase) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0, 195, 5);
  here_.move(walker, here_.path(walker).links.at(0).stop_line - 0.3);
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 12, 0, -1, "WC_1");
  const double line = here_.path(driver).links.at(0).stop_line;
  const auto waits = [&](double waited, double way) {
    here_.move(driver, line - 2.25 - way);
    here_.traffic.waiting_time[walker] = waited;
    here_.update();
    return here_.context(walker).foe == here_.scene.id[driver].value;
  };
  EXPECT_TRUE(waits(20, 48));
  EXPECT_FALSE(waits(40, 48)) << "four seconds away, it halts with 1.5 m/s^2";
  EXPECT_TRUE(waits(40, 28)) << "it would have to brake harder";
  // where they come one after the other somebody always comes within three seconds
  here_.set_speed(driver, 5.0);
  EXPECT_TRUE(waits(20, 10));
  EXPECT_FALSE(waits(40, 10));
  here_.set_speed(driver, 0.8);
  EXPECT_FALSE(waits(40, 1.5));
  EXPECT_TRUE(waits(40, -0.4)) << "it is on the crossing already";
}

// somebody set out and stepped back for 92 s, since its wait began anew each time
TEST_F(CrossingTest, WhoStepsBackHasWaitedSinceItCame) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0, 195, 5);
  const PathLink& link = here_.path(walker).links.at(0);
  here_.move(walker, link.stop_line - 0.3);
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 12, 0, -1, "WC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 2.25 - 48);
  const auto waits = [&](double came) {
    here_.traffic.halted_for[walker] = kNoConnection;
    here_.scene.time = came;
    here_.scene.held[walker].standing = 1.0;
    here_.update();
    here_.scene.time = 100;
    here_.scene.held[walker].standing = 0.0;
    here_.update();
    return here_.context(walker).foe == here_.scene.id[driver].value;
  };
  EXPECT_TRUE(waits(70));
  EXPECT_FALSE(waits(50));
}

// it forgot that it had waited with its first step, and turned round; a queue that crept over the
// crossing left no place to step onto
TEST_F(CrossingTest, WhoHasSetOutGoesOnAndDriversHaltForIt) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0, 195, 5);
  here_.move(walker, here_.path(walker).links.at(0).stop_line - 0.3);
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 1.5, 0, -1, "WC_1");
  const double line = here_.path(driver).links.at(0).stop_line;
  here_.move(driver, line - 2.25 - 3.0);
  const auto waited = [&](double time, double speed) {
    here_.traffic.waiting_time[walker] = time;
    here_.set_speed(walker, speed);
    here_.scene.context[walker].reason = LimitReason::Yield;
    here_.update();
    const bool walker_waits = here_.context(walker).foe == here_.scene.id[driver].value;
    const bool driver_halts = here_.context(driver).foe == here_.scene.id[walker].value;
    EXPECT_NE(walker_waits, driver_halts) << time << " s, " << speed << " m/s";
    return walker_waits;
  };
  EXPECT_TRUE(waited(20, 0));
  EXPECT_FALSE(waited(35, 0));
  EXPECT_FALSE(waited(20, 0.8));
  EXPECT_TRUE(waited(5, 0.8));
  here_.traffic.waiting_time[driver] = 15;
  here_.traffic.waiting_time[walker] = 35;
  here_.update();
  EXPECT_NE(here_.context(driver).foe, here_.scene.id[walker].value) << "it has waited long enough";
}

// A car that stood to give way would have been past by the time that somebody got there who hardly
// walked, not who walked: that one stepped forth and back at the kerb five times a second.
class StandingDriver : public CrossingTest {
 protected:
  /// At its line before the crossing over the west arm, where it gives way to `third`.
  StandingDriver()
      : walker_(here_.add("pedestrian", {"CW", "WC"}, 0, 0, 5, 195)),
        driver_(here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_1")),
        third_(here_.add("car", {"SC", "CN"}, 20, 0)) {
    here_.move(driver_, here_.path(driver_).links.at(0).stop_line - 2.25 - 0.6);
  }
  /// Does somebody on foot wait for it, so far past the place to wait at, at such a speed, and held
  /// by a rule or free a tick ago?
  bool waits(double past, double speed, double driver_waits, bool held) {
    const PathLink& link = here_.path(walker_).links.at(0);
    here_.set_speed(walker_, speed);
    here_.move(walker_, link.halt + past - 0.2);
    here_.scene.context[driver_].active = true;
    here_.scene.context[driver_].reason = LimitReason::Yield;
    here_.scene.context[driver_].foe = static_cast<std::int64_t>(here_.scene.id[third_].value);
    here_.scene.context[walker_].active = true;
    here_.scene.context[walker_].reason = held ? LimitReason::Yield : LimitReason::None;
    here_.traffic.waiting_time[driver_] = driver_waits;
    here_.update();
    return here_.context(walker_).foe == here_.scene.id[driver_].value;
  }
  std::size_t walker_, driver_, third_;
};

TEST_F(StandingDriver, IsWaitedForAtAnySpeed) {
  for (const double speed : {0.0, 0.1, 0.2, 0.4, 0.8, 1.2})
    EXPECT_TRUE(waits(-0.6, speed, 2.0, true)) << speed << " m/s";
}

TEST_F(StandingDriver, WhoHasLookedAndSetOutNeedNotLookAgain) {
  here_.traffic.waiting_time[walker_] = 3.0;
  EXPECT_FALSE(waits(-0.6, 0.0, 6.0, true)) << "it waits for somebody else and isn't about to go";
  here_.traffic.waiting_time[walker_] = 0.0;  // forgotten with the first step
  EXPECT_FALSE(waits(0.6, 0.8, 6.0, false));
  EXPECT_TRUE(waits(0.6, 0.8, 6.0, true)) << "it was held there";
}

TEST_F(CrossingTest, WalkersDoNotStepInFrontOfWhoCanNotStop) {
  const std::size_t walker = here_.add("pedestrian", {"CW", "WC"}, 0, 1.3, 5, 195);
  here_.move(walker, here_.path(walker).links.at(0).stop_line - 1.2);
  // westbound, about to leave the junction over the near half of the crossing
  const std::size_t driver = here_.add("car", {"EC", "CW"}, 0, 13, 0, -1, "EC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line + 2);
  here_.update();
  EXPECT_EQ(here_.context(walker).foe, here_.scene.id[driver].value);
  EXPECT_LT(here_.context(walker).allowed_speed, 1.3);
}

// who made way for others at the corner got onto a crossing that was red, and not its own
TEST(SignalledCorner, NobodyStepsAsideOntoACrossingThatIsRed) {
  const RoadNetwork net =
      read_plain_net(crossroads("traffic_light", {"--sidewalks.guess", "--crossings.guess"}));
  RoadScene here{net};
  // round the south-western corner, between two crossings
  const std::size_t walker = here.add("pedestrian", {"WC", "CS"}, 0, 1.3, 195, 5);
  ASSERT_TRUE(here.path(walker).links.empty());
  auto way_at = [&](double along, char signal) {
    here.road.signal_states.assign(net.signals.size(), std::string(32, signal));
    here.move(walker, along);
    here.update();
    return here.context(walker).to_red[0];
  };
  int bounded = 0;
  for (const PathStretch& stretch : here.path(walker).stretches) {
    if (net.lane(stretch.lane).kind != LaneKind::WalkingArea) continue;
    const double middle = 0.5 * (stretch.from + stretch.to);
    EXPECT_TRUE(way_at(middle, 'G').isZero());
    const Vec2 way = way_at(middle, 'r');
    if (way.isZero()) continue;
    ++bounded;
    const Vec2 edge = here.scene.position[walker] + way;
    double least = std::numeric_limits<double>::infinity();
    for (const Lane& lane : net.lanes) {
      if (lane.kind != LaneKind::Crossing) continue;
      const auto& points = lane.centerline.points();
      const double length = (points.back() - points.front()).norm();
      const Vec2 at = to_body(edge - points.front(), (points.back() - points.front()) / length);
      const Vec2 off(std::max({0.0, -at.x(), at.x() - length}),
                     std::max(0.0, std::abs(at.y()) - 0.5 * lane.width));
      least = std::min(least, off.norm());
    }
    const AgentType& type = type_of(here.model.types, here.scene.type[walker]);
    EXPECT_LE(least, 0.5 * std::hypot(type.length, type.width) + 1e-6)
        << "a crossing lies half a body further";
  }
  EXPECT_GT(bounded, 0);
}

TEST_F(CrossingTest, AnEmptyCrossingHoldsNobody) {
  const std::size_t driver = here_.add("car", {"EC", "CW"}, 0, 6, 0, -1, "EC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 14);
  here_.update();
  EXPECT_EQ(here_.context(driver).reason, LimitReason::None);
}

TEST(BrakingAsked, IsTheHarderTheCloserSomebodyIsCutInOn) {
  RoadScene here(testing::small_net());
  const std::size_t own = here.add("car", {"in", "out"}, 90, 0);
  const AgentType& type = type_of(here.model.types, here.scene.type[own]);
  const Path& path = here.path(own);
  auto asked = [&](double to_merged, double speed) {
    // both on ways like this one, whose places at 100 m are the same
    return braking_asked(TrafficParameters{}, {type, path, 92, 4.5, 0, 13, 100}, 95,
                         {type, path, 20, 4.5, speed, speed, 20 + to_merged});
  };
  EXPECT_EQ(asked(200, 12), 0.0);
  EXPECT_GT(asked(45, 12), 1.0);
  EXPECT_LT(asked(60, 12), asked(45, 12));
  EXPECT_TRUE(std::isinf(asked(10, 12)));
  EXPECT_LT(asked(30, 3), 1.0);  // slow traffic lets in at ease
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

TEST(HalfExtent, IsOfTheTurnedBox) {
  RoadScene here(testing::small_net());
  const std::size_t own = here.add("car", {"in", "out"}, 5, 2);
  EXPECT_NEAR(half_extent(here.scene, own, Vec2(1, 0)), 2.25, 1e-12);
  EXPECT_NEAR(half_extent(here.scene, own, Vec2(0, 1)), 0.9, 1e-12);
  here.scene.heading[own] = kPi / 2;
  EXPECT_NEAR(half_extent(here.scene, own, Vec2(1, 0)), 0.9, 1e-12);
}

}  // namespace
}  // namespace sumogamma
