#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "study/safety/conflicts.h"

namespace sumogamma {
namespace {

MovingBody body(double length, double width, const Vec2& position, double heading, double speed) {
  MovingBody made;
  made.footprint = box_footprint(length, width);
  made.position = position;
  made.heading = heading;
  made.velocity = speed * direction_of(heading);
  return made;
}

MovingBody car(double x, double y, double heading_degrees, double speed) {
  return body(4.0, 2.0, {x, y}, radians(heading_degrees), speed);
}

// [A]-> 10 m/s      [B]-> 4 m/s: 16 m between centres, 12 m of gap
TEST(TimeToCollision, IsGapOverDifferenceOfSpeedsInOneLane) {
  const MovingBody a = car(0, 0, 0, 10), b = car(16, 0, 0, 4);
  EXPECT_NEAR(outline_gap(a, b), 12.0, 1e-12);
  EXPECT_NEAR(time_to_collision(a, b, 5.0), 2.0, 1e-12);
  EXPECT_NEAR(time_to_collision(b, a, 5.0), 2.0, 1e-12);
  EXPECT_TRUE(std::isinf(time_to_collision(a, b, 1.9)));
}

TEST(TimeToCollision, IsInfiniteWhereNobodyComesNearer) {
  EXPECT_TRUE(std::isinf(time_to_collision(car(0, 0, 0, 5), car(16, 0, 0, 5), 60.0)));
  EXPECT_TRUE(std::isinf(time_to_collision(car(0, 0, 0, 4), car(16, 0, 0, 5), 60.0)));
  // past each other with 0.1 m between them
  EXPECT_TRUE(std::isinf(time_to_collision(car(0, 0, 0, 5), car(20, 2.1, 180, 5), 60.0)));
  EXPECT_NEAR(time_to_collision(car(0, 0, 0, 5), car(20, 1.9, 180, 5), 60.0), 1.6, 1e-12);
}

TEST(TimeToCollision, IsZeroInContact) {
  EXPECT_EQ(time_to_collision(car(0, 0, 0, 5), car(3.9, 0, 0, 9), 3.0), 0.0);
  EXPECT_EQ(outline_gap(car(0, 0, 0, 5), car(3.9, 0, 0, 9)), 0.0);
}

//            B goes down at 5 m/s and reaches A's lane (its lower end at y = 1) when its centre is
//            at
//  A->       y = 3; A's front comes to x = 9 (B's left side) at 7 m / 10 m/s = 0.7 s
TEST(TimeToCollision, OfCrossingWaysIsWhenTheSecondOfTwoComes) {
  const MovingBody a = car(0, 0, 0, 10);
  // B is in the lane from 0.6 s until 1.8 s: the first contact is A's front at 0.7 s
  EXPECT_NEAR(time_to_collision(a, car(10, 6, -90, 5), 5.0), 0.7, 1e-12);
  // B comes into the lane at 0.9 s, while A covers it: contact with A's side
  EXPECT_NEAR(time_to_collision(a, car(10, 7.5, -90, 5), 5.0), 0.9, 1e-12);
  // A has passed (its rear at x = 11 at 1.3 s) when B comes at 1.4 s
  EXPECT_TRUE(std::isinf(time_to_collision(a, car(10, 10, -90, 5), 5.0)));
}

TEST(TimeToCollision, OnArcsFollowsTheTurn) {
  // A turns left on a circle of 20 m about (0, 20); B stands on it, a quarter turn ahead
  MovingBody a = car(0, 0, 0, 10);
  a.turn_rate = 0.5;
  MovingBody b = car(20, 20, 90, 0);
  const double time = time_to_collision(a, b, 5.0);
  // fronts meet ends where the arc between the centres is about a car's length
  EXPECT_NEAR(time, (radians(90.0) - 4.0 / 20.0) / 0.5, 0.03);
  // straight ahead it misses
  a.turn_rate = 0;
  EXPECT_TRUE(std::isinf(time_to_collision(a, b, 5.0)));
  const MovingBody quarter = moved(MovingBody{a.footprint, {0, 0}, 0, {10, 0}, 0.5}, kPi);
  EXPECT_NEAR((quarter.position - Vec2(20, 20)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((quarter.velocity - Vec2(0, 10)).norm(), 0.0, 1e-9);
}

TEST(TimeToCollision, AgreesWithSteppingInTime) {
  constexpr double kTimeStep = 2.5e-3;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const auto draw = [&](std::uint64_t k, double low, double high) {
      return random_uniform(seed, k, 0, Draw::Demand, low, high);
    };
    MovingBody a = car(0, 0, draw(1, 0, 360), draw(2, 0, 15));
    MovingBody b =
        body(1.7, 0.6, {draw(3, -20, 20), draw(4, -20, 20)}, draw(5, 0, 6), draw(6, 0, 8));
    if (seed % 2 == 0) a.turn_rate = draw(7, -0.6, 0.6);
    double stepped = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 1200 && std::isinf(stepped); ++k)
      if (outline_gap(moved(a, kTimeStep * k), moved(b, kTimeStep * k)) <= 0.0)
        stepped = kTimeStep * k;
    const double time = time_to_collision(a, b, 3.0);
    // a graze of less than a step may be missed by stepping
    if (std::isfinite(stepped)) {
      EXPECT_NEAR(time, stepped, kTimeStep + 1e-3);
    } else if (std::isfinite(time)) {
      EXPECT_LT(outline_gap(moved(a, time), moved(b, time)), 2e-3);
    }
  }
}

TEST(Deceleration, IsThatOfCarFollowing) {
  // 10 behind 4 m/s, gap 12 m: 6^2 / (2 12)
  const MovingBody a = car(0, 0, 0, 10), b = car(16, 0, 0, 4);
  const double time = time_to_collision(a, b, 5.0);
  EXPECT_NEAR(deceleration_to_avoid(6.0, time), 36.0 / 24.0, 1e-12);
  // after a second of reaction 6 m of the gap are left
  EXPECT_NEAR(modified_deceleration_to_avoid(6.0, time), 36.0 / 12.0, 1e-12);
  EXPECT_TRUE(std::isinf(modified_deceleration_to_avoid(6.0, 0.9)));
  EXPECT_EQ(deceleration_to_avoid(6.0, std::numeric_limits<double>::infinity()), 0.0);
}

/// Bodies that go straight on, watched.
class Conflicts : public ::testing::Test {
 protected:
  void add(const char* type, const Vec2& position, double heading_degrees, double speed) {
    AgentState agent;
    agent.id = AgentId{static_cast<std::uint32_t>(scene_.size())};
    agent.type = find_agent_type(types_, type);
    agent.footprint = box_footprint(4.0, 2.0);
    agent.position = position;
    agent.heading = radians(heading_degrees);
    agent.speed = speed;
    append_agent(scene_, agent);
    scene_.velocity.back() = speed * direction_of(agent.heading);
  }
  template <typename Monitor>
  void run(Monitor&& add, double seconds) {
    for (int tick = 0; tick < static_cast<int>(seconds / kStep); ++tick) {
      scene_.time = tick * kStep;
      add();
      for (std::size_t row = 0; row < scene_.size(); ++row)
        scene_.position[row] += kStep * scene_.velocity[row];
    }
  }

  static constexpr double kStep = 0.05;
  AgentTypeTable types_ = default_agent_types();
  Scene scene_;
};

// the first passes x = 10 from south to north and has left A's lane, its rear at y = 1, after
// (10 + 1 + 2) / 10 = 1.3 s; the second's front comes to x = 9 after (30 - 2 + 9) / 10 = 3.7 s
TEST_F(Conflicts, PostEncroachmentIsFromLeavingToArriving) {
  add("car", {10, -10}, 90, 10);
  add("car", {-30, 0}, 0, 10);
  EncroachmentMonitor monitor(kStep);
  double least = 100;
  run(
      [&] {
        for (const Encroachment& found : monitor.add(scene_)) {
          EXPECT_EQ(found.row, 1u);
          EXPECT_EQ(found.before, AgentId{0});
          EXPECT_NEAR(found.angle, radians(90.0), 1e-9);
          least = std::min(least, found.time);
        }
      },
      8.0);
  EXPECT_NEAR(least, 2.4, kStep + 1e-9);
}

TEST_F(Conflicts, FollowingIsNoEncroachment) {
  add("car", {10, 0}, 0, 10);
  add("car", {0, 0}, 10, 10);
  EncroachmentMonitor monitor(kStep);
  std::size_t found = 0;
  run([&] { found += monitor.add(scene_).size(); }, 4.0);
  EXPECT_EQ(found, 0u);
}

TEST_F(Conflicts, AreTakenForBothThresholds) {
  // 12 m gap, 6 m/s: 2 s at first; it stops getting nearer after 1 s
  add("car", {0, 0}, 0, 10);
  add("car", {16, 0}, 0, 4);
  add("bus", {0, 100}, 0, 10);
  ConflictMonitor monitor(kStep);
  int tick = 0;
  run(
      [&] {
        monitor.add(scene_, types_);
        if (++tick == 8) scene_.velocity[0] = scene_.velocity[1];
      },
      2.0);
  ASSERT_EQ(monitor.conflicts().size(), 1u);
  const Conflict conflict = monitor.conflicts().front();
  // looked at every 0.1 s, last at 0.3 s: 2 s less 0.3 s
  EXPECT_NEAR(conflict.time_to_collision, 1.7, 1e-9);
  EXPECT_NEAR(conflict.gap, 12.0 - 6.0 * 0.4, 0.7);
  EXPECT_NEAR(conflict.deceleration, 6.0 / (2 * 1.7), 1e-9);
  EXPECT_EQ(conflict.kind, ConflictKind::RearEnd);
  const SafetyResult result = monitor.result(types_);
  EXPECT_EQ(result.conflicts_sumo, 1u);
  EXPECT_EQ(result.conflicts_fhwa, 0u);
  EXPECT_EQ(result.near_misses, 0u);
}

TEST_F(Conflicts, ANearMissIsNoContact) {
  add("car", {0, 0}, 0, 10);
  add("bicycle", {14, 0}, 0, 0);
  ConflictMonitor monitor(kStep);
  int tick = 0;
  run(
      [&] {
        monitor.add(scene_, types_);
        if (++tick == 16) scene_.velocity[0] = Vec2::Zero();
      },
      6.0);
  const SafetyResult result = monitor.result(types_);
  EXPECT_EQ(result.near_misses, 1u);
  EXPECT_EQ(result.conflicts_fhwa, 1u);
  EXPECT_EQ(result.by_types.at("bicycle-car"), 1u);
  EXPECT_NEAR(result.least_gap_m, 2.0, 0.6);
  EXPECT_GT(result.time_exposed_s, 0.0);

  ConflictMonitor until_contact(kStep);
  scene_.velocity[0] = {10, 0};
  run([&] { until_contact.add(scene_, types_); }, 1.0);
  EXPECT_EQ(until_contact.result(types_).near_misses, 0u);
  EXPECT_TRUE(until_contact.conflicts().front().touched);
}

TEST_F(Conflicts, TwoOnFootAreLeftOut) {
  add("pedestrian", {0, 0}, 0, 1.3);
  add("pedestrian", {6, 0}, 180, 1.3);
  ConflictMonitor monitor(kStep);
  run([&] { monitor.add(scene_, types_); }, 2.0);
  EXPECT_TRUE(monitor.conflicts().empty());
}

TEST_F(Conflicts, EncountersFarApartInTimeAreTwo) {
  add("car", {0, 0}, 0, 10);
  add("car", {14, 0}, 0, 5);
  ConflictMonitor monitor(kStep);
  run(
      [&] {
        // nearer for half a second, then the gap is held, then nearer again
        const bool closes = scene_.time < 0.5 || (scene_.time > 6.0 && scene_.time < 6.5);
        scene_.velocity[0].x() = closes ? 10 : 5;
        monitor.add(scene_, types_);
      },
      8.0);
  EXPECT_EQ(monitor.conflicts().size(), 2u);
}

}  // namespace
}  // namespace sumogamma
