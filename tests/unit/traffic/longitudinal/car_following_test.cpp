#include "traffic/longitudinal/car_following.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sumogamma {
namespace {

constexpr double kFree = std::numeric_limits<double>::infinity();

const AgentType& car() {
  static const AgentTypeTable types = default_agent_types();
  return type_of(types, find_agent_type(types, "car"));
}

TEST(FollowingAcceleration, OnAFreeRoadReachesTheSpeedAndKeepsIt) {
  EXPECT_DOUBLE_EQ(following_acceleration(car(), 0, 13.9, kFree, 0), car().max_acceleration);
  EXPECT_NEAR(following_acceleration(car(), 13.9, 13.9, kFree, 0), 0.0, 1e-12);
  EXPECT_GT(following_acceleration(car(), 13.0, 13.9, kFree, 0), 0.0);
  double speed = 0;
  for (int k = 0; k < 2400; ++k)
    speed += 0.05 * following_acceleration(car(), speed, 13.9, kFree, 0);
  EXPECT_NEAR(speed, 13.9, 0.02);
}

// with the fourth power 0.59 of it were left at four fifths of the speed
TEST(FollowingAcceleration, KeepsMostOfItUpToNearTheSpeed) {
  EXPECT_GT(following_acceleration(car(), 0.8 * 13.9, 13.9, kFree, 0),
            0.8 * car().max_acceleration);
}

TEST(FollowingAcceleration, SlowsForALowerLimitAtEase) {
  EXPECT_DOUBLE_EQ(following_acceleration(car(), 30, 8, kFree, 0), -car().comfortable_deceleration);
}

TEST(FollowingAcceleration, KeepsTheStandstillGapAndTheHeadway) {
  EXPECT_NEAR(following_acceleration(car(), 0, 13.9, car().min_gap, 0), 0.0, 1e-12);
  EXPECT_LT(following_acceleration(car(), 0, 13.9, 0.5 * car().min_gap, 0), 0.0);
  EXPECT_GT(following_acceleration(car(), 0, 13.9, 2.0 * car().min_gap, 0), 0.0);
  // Treiber et al. 2000, Eq. 7: gap of equilibrium at speed v behind somebody as fast, far below
  // the free speed
  for (const double speed : {3.0, 5.0, 8.0, 15.0}) {
    const double gap = car().min_gap + speed * kept_headway(car(), speed);
    EXPECT_NEAR(following_acceleration(car(), speed, 150, gap, speed), 0.0, 1e-3);
  }
}

TEST(KeptHeadway, DriversCloseUpInAQueueAndALaneDischargesAtOneRate) {
  EXPECT_DOUBLE_EQ(kept_headway(car(), 11.0), car().headway);
  EXPECT_DOUBLE_EQ(kept_headway(car(), 33.0), car().headway);
  EXPECT_LT(kept_headway(car(), 5.0), 0.8 * car().headway);
  EXPECT_GT(kept_headway(car(), 0.0), 0.3);
  // HCM 2010: 1.8 to 1.9 s from front to front; a constant time gap would leave 2.1 s at 7 m/s
  for (double speed = 7.0; speed <= 14.0; speed += 0.5) {
    const double spacing = car().length + car().min_gap + speed * kept_headway(car(), speed);
    EXPECT_NEAR(spacing / speed, 1.84, 0.1) << speed;
  }
}

TEST(HeadwayMemory, WhoFlowsFollowsCloserThanWhoComesOutOfAQueue) {
  EXPECT_DOUBLE_EQ(headway_memory(TrafficParameters{}, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(headway_memory(TrafficParameters{}, 30.0), 1.0) << "over the line of a signal";
  EXPECT_LT(headway_memory(TrafficParameters{}, 60.0), 0.95);
  EXPECT_DOUBLE_EQ(headway_memory(TrafficParameters{}, kFree),
                   headway_memory(TrafficParameters{}, 90.0))
      << "who never stood";
  const double flowing = headway_memory(TrafficParameters{}, kFree) * kept_headway(car(), 25.0);
  EXPECT_NEAR(flowing, 1.0, 0.1) << "about a second";
}

TEST(FollowingAcceleration, BrakesFullyOnContactAndNeverHarder) {
  EXPECT_DOUBLE_EQ(following_acceleration(car(), 10, 13.9, 0, 0), -car().max_deceleration);
  EXPECT_DOUBLE_EQ(following_acceleration(car(), 10, 13.9, -3, 0), -car().max_deceleration);
  EXPECT_DOUBLE_EQ(following_acceleration(car(), 30, 33, 1, 0), -car().max_deceleration);
}

TEST(FollowingAcceleration, StopsBehindAWallWithoutTouchingIt) {
  double place = 0, speed = 13.9, hardest = 0;
  constexpr double kWall = 80, kStep = 0.05;
  for (int k = 0; k < 2000; ++k) {
    const double a = following_acceleration(car(), speed, 13.9, kWall - place, 0);
    hardest = std::min(hardest, a);
    speed = std::max(0.0, speed + a * kStep);
    place += speed * kStep;
  }
  EXPECT_LT(speed, 0.05);
  EXPECT_LT(place, kWall);
  EXPECT_NEAR(kWall - place, car().min_gap, 0.3);
  EXPECT_GT(hardest, -4.0);
}

TEST(FollowingAcceleration, APlatoonDampsTheBrakingOfItsLeader) {
  // the leader brakes to a standstill, stands, and goes again: however far back, nobody brakes
  // harder than is comfortable, nobody touches, all go again
  constexpr int kCars = 20;
  constexpr double kStep = 0.05, kLength = 4.5;
  double place[kCars], speed[kCars], hardest[kCars] = {};
  for (int i = 0; i < kCars; ++i) {
    place[i] = -25.0 * i;
    speed[i] = 13.0;
  }
  double smallest_gap = kFree;
  for (int k = 0; k < 3200; ++k) {
    const double t = k * kStep;
    double lead = t < 5 ? 0.0 : t < 25 ? -2.0 : 1.5;
    for (int i = 0; i < kCars; ++i) {
      double a = lead;
      if (i > 0) {
        const double gap = place[i - 1] - kLength - place[i];
        smallest_gap = std::min(smallest_gap, gap);
        a = following_acceleration(car(), speed[i], 13.9, gap, speed[i - 1]);
      }
      hardest[i] = std::min(hardest[i], a);
      speed[i] = std::clamp(speed[i] + a * kStep, 0.0, 13.9);
      place[i] += speed[i] * kStep;
    }
  }
  EXPECT_GT(smallest_gap, 0.5);
  for (int i = 1; i < kCars; ++i)
    EXPECT_GT(hardest[i], -1.05 * car().comfortable_deceleration) << "car " << i;
  for (int i = 0; i < kCars; ++i) EXPECT_GT(speed[i], 9.0) << "car " << i;
}

TEST(BrakingBehind, KeepsTwoApart) {
  EXPECT_DOUBLE_EQ(braking_behind(10, {20, 10, 0}), 0.0);
  EXPECT_DOUBLE_EQ(braking_behind(10, {20, 12, 0}), 0.0);
  EXPECT_DOUBLE_EQ(braking_behind(10, {4.5, 7, 0}), 1.0);
  EXPECT_DOUBLE_EQ(braking_behind(10, {4.5, 7, 2.0}), 1.0);  // nobody counts on others to speed up
  EXPECT_DOUBLE_EQ(braking_behind(12, {8, 10, -1}), 1.25);
  // the other stands after 10 m: 15 m are left for 10 m/s
  EXPECT_DOUBLE_EQ(braking_behind(10, {5, 10, -5}), 100.0 / 30.0);
}

TEST(BehindAcceleration, IsThePlainModelWhereThatIsNoHarder) {
  for (const double gap : {12.0, 20.0, 60.0, kFree})
    EXPECT_DOUBLE_EQ(behind_acceleration(car(), 8, 13.9, {gap, 10, 0}),
                     following_acceleration(car(), 8, 13.9, gap, 10));
}

TEST(BehindAcceleration, LetsTheGapOpenAtEaseBehindWhoCutsIn) {
  EXPECT_LT(following_acceleration(car(), 10, 13.9, 4.5, 9.5), -7.0);
  const double calm = behind_acceleration(car(), 10, 13.9, {4.5, 9.5, 0});
  EXPECT_GT(calm, -1.1 * car().comfortable_deceleration);
  EXPECT_LT(calm, -0.5);
}

TEST(BehindAcceleration, StopsInTimeBehindWhoBrakesAsHardAsItCan) {
  constexpr double kStep = 0.05;
  double lead = 14, lead_place = 0, speed = 14, place = -4.5 - 12;
  for (int k = 0; k < 400; ++k) {
    const double braking = lead > 0 ? -7.0 : 0.0;
    const double a =
        behind_acceleration(car(), speed, 13.9, {lead_place - 4.5 - place, lead, braking});
    speed = std::max(0.0, speed + a * kStep);
    place += speed * kStep;
    lead = std::max(0.0, lead + braking * kStep);
    lead_place += lead * kStep;
    ASSERT_GT(lead_place - 4.5 - place, 0.3) << k * kStep;
  }
  EXPECT_LT(speed, 0.3);
}

TEST(DecelerationToStop, IsTheConstantOne) {
  EXPECT_DOUBLE_EQ(deceleration_to_stop(10, 25), 2.0);
  EXPECT_DOUBLE_EQ(deceleration_to_stop(0, 0), 0.0);
  EXPECT_TRUE(std::isinf(deceleration_to_stop(1, 0)));
  EXPECT_TRUE(std::isinf(deceleration_to_stop(1, -1)));
}

TEST(TimeToCover, AcceleratesThenCruises) {
  EXPECT_DOUBLE_EQ(time_to_cover(0, 5, 10, 2), 0.0);
  EXPECT_DOUBLE_EQ(time_to_cover(-3, 5, 10, 2), 0.0);
  EXPECT_NEAR(time_to_cover(25, 0, 10, 2), 5.0, 1e-12);  // just reaches 10 m/s
  EXPECT_NEAR(time_to_cover(45, 0, 10, 2), 7.0, 1e-12);  // 5 s + 20 m at 10 m/s
  EXPECT_NEAR(time_to_cover(4, 0, 10, 2), 2.0, 1e-12);
  EXPECT_NEAR(time_to_cover(30, 15, 10, 2), 2.0, 1e-12);  // already faster: keeps its speed
  EXPECT_TRUE(std::isfinite(time_to_cover(10, 0, 0, 1)));
}

}  // namespace
}  // namespace sumogamma
