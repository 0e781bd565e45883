#include "traffic/longitudinal/leader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/road_scene.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::RoadScene;

//   in_1 -> out_0, 200 m eastwards at y = 0; back_in_0 -> back_0 westwards at y = -3.2
class LeaderTest : public ::testing::Test {
 protected:
  Leader leader_of(std::size_t row, double reach = 100) {
    here_.update();
    DrivingAhead ahead;
    return find_leader(here_.view(), row, reach, ahead);
  }
  RoadScene here_{testing::small_net()};
};

TEST_F(LeaderTest, NobodyAheadIsAFreeRoad) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 10);
  here_.add("car", {"in", "out"}, 5, 10);  // behind
  const Leader leader = leader_of(own);
  EXPECT_EQ(leader.id, -1);
  EXPECT_TRUE(std::isinf(leader.gap));
}

TEST_F(LeaderTest, GapIsFromBumperToBumper) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 10);
  here_.add("bus", {"in", "out"}, 60, 7);
  const Leader leader = leader_of(own);
  EXPECT_EQ(leader.id, 1);
  EXPECT_NEAR(leader.gap, 40 - 2.25 - 6.0, 1e-9);
  EXPECT_NEAR(leader.speed, 7, 1e-9);
  EXPECT_NEAR(leader.along, 54, 1e-9);
}

TEST_F(LeaderTest, TheNearestOfSeveralBinds) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 10);
  here_.add("car", {"in", "out"}, 80, 0);
  here_.add("bicycle", {"in", "out"}, 40, 4);
  EXPECT_EQ(leader_of(own).id, 2);
}

TEST_F(LeaderTest, TheRestOfAQueueIsAddedOnceAsFarAsItIsLookedAt) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 5);
  here_.add("car", {"in", "out"}, 50, 5);
  here_.add("bus", {"in", "out"}, 80, 3);  // about where the leader's reach ends
  here_.add("car", {"in", "out"}, 100, 0);
  here_.add("car", {"back_in", "back"}, 90, 5);  // comes the other way
  here_.add("car", {"in", "out"}, 150, 0);
  here_.update();
  DrivingAhead ahead;
  find_leader(here_.view(), own, 59.5, ahead);
  const auto see_as_far_as = [&](double to) { see_queue(here_.view(), own, to, ahead); };
  see_as_far_as(70);  // it has been seen already
  see_as_far_as(120);
  std::vector<std::int64_t> ids;
  for (std::size_t k = 0; k < ahead.count; ++k) ids.push_back(ahead.vehicles[k].id);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(ahead.seen_to, 120);
  for (std::size_t k = 0; k < ahead.count; ++k)
    if (ahead.vehicles[k].id == 3) {
      EXPECT_NEAR(ahead.vehicles[k].rear, 100 - 2.25, 1e-9);
      EXPECT_NEAR(ahead.vehicles[k].front, 100 + 2.25, 1e-9);
    }
  see_as_far_as(200);
  EXPECT_EQ(ahead.count, 4u);
}

TEST_F(LeaderTest, OncomingTrafficAndTheNextLaneDoNotBind) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 10);
  here_.add("car", {"back_in", "back"}, 150, 10);
  EXPECT_EQ(leader_of(own).id, -1);
  // even one that stands across or against on the own lane is no leader: avoidance sees to it
  const std::size_t wrong = here_.add("car", {"in", "out"}, 50, 0);
  here_.scene.heading[wrong] = kPi;
  EXPECT_EQ(leader_of(own).id, -1);
}

TEST_F(LeaderTest, SomebodyBesideTheWayCountsOnlyWhereBodiesWouldMeet) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 10);
  const std::size_t rider = here_.add("bicycle", {"in", "out"}, 60, 4);
  here_.move(rider, 60, 1.0);
  EXPECT_EQ(leader_of(own).id, 1);
  here_.move(rider, 60, 1.8);
  EXPECT_EQ(leader_of(own).id, -1);
}

// a car went back to its side through between a bicycle and the middle of the road, at 10 m/s and
// 4 cm from it: it was not far from where it aimed for the moment, but from where it wanted to be
TEST_F(LeaderTest, WhoGivesUpOvertakingFollowsThoughItIsClearOfTheOtherYet) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 10);
  const std::size_t rider = here_.add("bicycle", {"in", "out"}, 30, 4);
  here_.move(own, 20, 1.6);
  here_.traffic.lateral_aim[own] = 1.6;
  here_.traffic.passing_offset[own] = 1.6;
  EXPECT_EQ(leader_of(own).id, -1);
  here_.traffic.passing_offset[own] = 0.0;
  EXPECT_EQ(leader_of(own).id, static_cast<std::int64_t>(here_.scene.id[rider].value));
}

TEST_F(LeaderTest, OfTwoAbreastWhoPressTogetherOneIsAhead) {
  const std::size_t a = here_.add("car", {"in", "out"}, 50, 5);
  const std::size_t b = here_.add("car", {"in", "out"}, 50.4, 5);
  here_.move(a, 50, 1.0);
  here_.move(b, 50.4, -1.0);
  // both lean towards each other
  here_.scene.heading[a] = here_.scene.heading[a] - 0.3;
  here_.scene.heading[b] = here_.scene.heading[b] + 0.3;
  const bool a_follows = leader_of(a).id == here_.scene.id[b].value;
  const bool b_follows = leader_of(b).id == here_.scene.id[a].value;
  EXPECT_FALSE(a_follows && b_follows);
}

// Two who change into each other's lane: each has its middle ahead along its own crossing way.
TEST_F(LeaderTest, OfTwoWhoseWaysCrossOneIsAhead) {
  for (const double ahead : {-1.9, -0.8, 0.0, 0.8, 1.9}) {
    RoadScene here{testing::small_net()};
    const std::size_t a = here.add("van", {"in", "out"}, 50, 5);
    const std::size_t b = here.add("van", {"in", "out"}, 50, 5);
    here.move(a, 50, 1.2);
    here.move(b, 50 + ahead, -1.2);
    here.scene.heading[a] = here.scene.heading[a] - 0.45;
    here.scene.heading[b] = here.scene.heading[b] + 0.45;
    here.update();
    const auto follows = [&](std::size_t row, std::size_t other) {
      DrivingAhead list;
      return find_leader(here.view(), row, 100, list).id ==
             static_cast<std::int64_t>(here.scene.id[other].value);
    };
    EXPECT_FALSE(follows(a, b) && follows(b, a)) << ahead;
  }
}

TEST_F(LeaderTest, PeopleOnFootCountOnceNear) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 5);
  const std::size_t walker = here_.add("pedestrian", {"in"}, 30, 1);
  here_.scene.position[walker] = {60, 0};
  here_.scene.heading[walker] = kPi / 2;
  here_.set_speed(walker, 1);
  EXPECT_EQ(leader_of(own).id, -1);
  here_.scene.position[walker] = {30, 0};
  const Leader leader = leader_of(own);
  EXPECT_EQ(leader.id, 1);
  EXPECT_NEAR(leader.speed, 0.0, 1e-9);
}

// a van went on by centimetres before somebody on foot who came towards it, and waited anew each
// time
TEST_F(LeaderTest, SomebodyOnFootWhoShufflesBeforeAVehicleIsWaitedForForSomeTime) {
  const std::size_t van = here_.add("van", {"in", "out"}, 25, 0.05);
  const std::size_t walker = here_.add("pedestrian", {"in"}, 30, 0.1);
  here_.scene.position[walker] = {30, 0};
  here_.scene.heading[walker] = kPi;
  here_.traffic.waiting_time[van] = 5;
  EXPECT_EQ(leader_of(van).id, 1);
  here_.traffic.waiting_time[van] = 15;
  EXPECT_EQ(leader_of(van).id, -1);
}

TEST_F(LeaderTest, TrafficOnABridgeIsNotInTheWay) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 10);
  const std::size_t above = here_.add("car", {"bridge"}, 60, 0);
  here_.scene.heading[above] = 0;  // as if it were aligned: only its height keeps it apart
  EXPECT_EQ(leader_of(own).id, -1);
  EXPECT_NEAR(here_.scene.height[above], 6.0, 1e-9);
}

TEST_F(LeaderTest, WhoeverDrivesItAndHoweverFarItReaches) {
  const std::size_t own = here_.add("car", {"in", "out"}, 20, 10);
  const std::size_t other = here_.add("car", {"in", "out"}, 90, 3);
  here_.scene.control[other] = Control::External;
  EXPECT_EQ(leader_of(own, 100).id, 1);
  EXPECT_EQ(leader_of(own, 50).id, -1);
}

}  // namespace
}  // namespace sumogamma
