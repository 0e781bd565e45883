#include "traffic/junction/keep_clear.h"

#include <gtest/gtest.h>

#include "support/junction_scenes.h"
#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::PriorityTest;
using testing::read_plain_net;
using testing::RoadScene;

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

}  // namespace
}  // namespace sumogamma
