#include "traffic/junction/laws.h"

#include <gtest/gtest.h>

#include "model/context.h"
#include "model/gamma_velocity.h"
#include "support/junction_scenes.h"
#include "support/lights.h"
#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::CrossingTest;
using testing::crossroads;
using testing::PriorityTest;
using testing::read_plain_net;
using testing::RoadScene;
using testing::show;

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

TEST_F(CrossingTest, AnEmptyCrossingHoldsNobody) {
  const std::size_t driver = here_.add("car", {"EC", "CW"}, 0, 6, 0, -1, "EC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 14);
  here_.update();
  EXPECT_EQ(here_.context(driver).reason, LimitReason::None);
}

}  // namespace
}  // namespace sumogamma
