#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "model/context.h"
#include "support/road_scene.h"
#include "support/small_net.h"
#include "traffic/longitudinal/car_following.h"

namespace sumogamma {
namespace {

constexpr std::uint64_t kSeeds = 200;

/// Draws from one stream of a seed.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : seed_(seed) {}
  double between(double low, double high) {
    return random_uniform(seed_, count_++, 0, Draw::Demand, low, high);
  }
  std::size_t below(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(between(0, static_cast<double>(n))));
  }

 private:
  std::uint64_t seed_, count_ = 0;
};

TEST(RoadRules, StandingIsAlwaysAllowed) {
  testing::RoadScene here(testing::small_net());
  const std::size_t car = here.add("car", {"in", "out"}, 40, 5);
  for (const AgentType& type : here.model.types)
    if (type.kinematics == Kinematics::SingleTrack)
      here.add(find_agent_type(here.model.types, type.name), here.road.paths[car], 40, 3);
  here.add("pedestrian", {"in"}, 40, 1);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    for (std::size_t row = 0; row < here.scene.size(); ++row) {
      RoadContext& context = here.scene.context[row];
      context.active = true;
      context.tangent = direction_of(draws.between(-kPi, kPi));
      context.room_left = draws.between(-5, 5);
      context.room_right = draws.between(0, 1) < 0.2 ? std::numeric_limits<double>::infinity()
                                                     : draws.between(-5, 5);
      context.allowed_speed = draws.between(-1, 10);
      here.scene.heading[row] = draws.between(-kPi, kPi);
      here.scene.speed[row] = draws.between(0, 15);
      here.scene.steering[row] = draws.between(-0.6, 0.6);
      ConstraintSet set;
      append_contextual_constraints(here.model, here.scene, row, set);
      EXPECT_EQ(set.planes.size(), set.sources.size());
      for (const HalfPlane& plane : set.planes) {
        EXPECT_GE(slack(plane, Vec2::Zero()), -1e-12);
        EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-9);
        EXPECT_TRUE(plane.point.allFinite());
      }
    }
  }
}

TEST(RoadRules, ContextsOfRealPlacesAreFinite) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    testing::RoadScene here(testing::small_net());
    for (int k = 0; k < 12; ++k) {
      const char* kinds[] = {"car", "bus", "bicycle", "motorcycle"};
      here.add(kinds[draws.below(4)], {"in", "out"}, draws.between(0, 200), draws.between(0, 14));
    }
    here.add("pedestrian", {"in"}, draws.between(0, 95), 1);
    for (std::size_t row = 0; row < here.scene.size(); ++row)
      here.move(row, here.scene.path_along[row], draws.between(-3, 3));
    here.road.signal_states[0] = draws.between(0, 1) < 0.5 ? "Gr" : "rG";
    here.update(2);
    for (std::size_t row = 0; row < here.scene.size(); ++row) {
      const RoadContext& context = here.context(row);
      EXPECT_TRUE(context.active);
      EXPECT_NEAR(context.tangent.norm(), 1.0, 1e-9);
      EXPECT_TRUE(context.sub_goal.allFinite());
      EXPECT_GE(context.allowed_speed, 0.0);
      EXPECT_GT(context.speed_limit, 0.0);
      // a reason to wait always says for whom, and never for oneself
      if (context.reason == LimitReason::Leader || context.reason == LimitReason::Yield) {
        EXPECT_GE(context.foe, 0);
      }
      EXPECT_NE(context.foe, here.scene.id[row].value);
    }
  }
}

TEST(Following, NeverLeavesTheLimitsOfItsType) {
  const AgentTypeTable types = default_agent_types();
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    for (const AgentType& type : types)
      for (int k = 0; k < 50; ++k) {
        const double speed = draws.between(0, type.max_speed),
                     gap = draws.between(0, 1) < 0.1 ? std::numeric_limits<double>::infinity()
                                                     : draws.between(-5, 100);
        const double free_speed = draws.between(0, 40), leader = draws.between(0, 40);
        const double a = following_acceleration(type, speed, free_speed, gap, leader);
        EXPECT_GE(a, -type.max_deceleration);
        EXPECT_LE(a, type.max_acceleration);
        // monotone: a wider gap and a faster leader never make it slower
        EXPECT_LE(a, following_acceleration(type, speed, free_speed, gap + 1, leader) + 1e-12);
        EXPECT_LE(a, following_acceleration(type, speed, free_speed, gap, leader + 1) + 1e-12);
      }
  }
}

TEST(Following, NeverTouchesALeaderThatDrivesAsItPleases) {
  const AgentTypeTable types = default_agent_types();
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    const AgentType& type = types[draws.below(types.size())];
    const double step = draws.between(0.02, 0.1);
    const double free_speed = std::min(type.max_speed, draws.between(3, 25));
    double speed = draws.between(0, free_speed), leader_speed = draws.between(0, free_speed);
    // far enough to begin with for what each can brake at ease
    double gap = type.min_gap + speed * type.headway +
                 std::max(0.0, (speed * speed - leader_speed * leader_speed) /
                                   (2 * type.comfortable_deceleration));
    double wish = 0;
    for (int k = 0; k < 3000; ++k) {
      if (k % 40 == 0) wish = draws.between(-type.comfortable_deceleration, type.max_acceleration);
      leader_speed = std::clamp(leader_speed + wish * step, 0.0, free_speed);
      const double a = following_acceleration(type, speed, free_speed, gap, leader_speed);
      speed = std::max(0.0, speed + a * step);
      gap += (leader_speed - speed) * step;
      ASSERT_GT(gap, 0.0) << type.name << " after " << k * step << " s";
      ASSERT_LE(speed, 1.05 * free_speed);
    }
  }
}

}  // namespace
}  // namespace sumogamma
