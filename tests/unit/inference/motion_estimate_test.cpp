#include "inference/motion_estimate.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "inference/hypotheses.h"

namespace sumogamma {
namespace {

const MotionNoise kNoise{.observation = 0.02,
                         .acceleration_variance = 0.3,
                         .acceleration_time = 1.0,
                         .velocity_drift = 0.01};

std::vector<Vec2> straight(const Vec2& velocity, std::size_t frames) {
  std::vector<Vec2> position;
  for (std::size_t k = 0; k < frames; ++k)
    position.push_back(Vec2(3, -2) + 0.4 * static_cast<double>(k) * velocity);
  return position;
}

TEST(MotionFilter, FindsAConstantVelocity) {
  const MotionEstimate estimate = MotionFilter(kNoise, 0.4).estimate(straight({1.2, -0.5}, 8));
  EXPECT_NEAR(estimate.velocity.x(), 1.2, 0.02);
  EXPECT_NEAR(estimate.velocity.y(), -0.5, 0.02);
  EXPECT_NEAR(estimate.turn_rate, 0.0, 0.02);
}

TEST(MotionFilter, LooksBackEightFramesOnly) {
  std::vector<Vec2> position = straight({1, 0}, 30);
  const MotionFilter filter(kNoise, 0.4);
  const Vec2 before = filter.estimate(position).velocity;
  position[20] += Vec2(50, 50);
  EXPECT_EQ(filter.estimate(position).velocity, before);
  position[22] += Vec2(0.1, 0);
  EXPECT_NE(filter.estimate(position).velocity, before);
}

TEST(MotionFilter, TurnsWithTheWorld) {
  std::vector<Vec2> position, turned;
  const Vec2 by = direction_of(0.7);
  for (int k = 0; k < 8; ++k) {
    position.push_back({0.5 * k, 0.05 * k * k});
    turned.push_back(Vec2(9, 4) + from_body(position.back(), by));
  }
  const MotionFilter filter(kNoise, 0.4);
  const Vec2 expected = from_body(filter.estimate(position).velocity, by);
  EXPECT_NEAR((filter.estimate(turned).velocity - expected).norm(), 0.0, 1e-9);
  EXPECT_NEAR(filter.estimate(turned).turn_rate, filter.estimate(position).turn_rate, 1e-9);
  EXPECT_GT(filter.estimate(position).turn_rate, 0.05);  // a left bend
}

TEST(MotionFilter, KnowsNothingOfANewcomer) {
  const MotionFilter filter(kNoise, 0.4);
  EXPECT_EQ(filter.estimate({}).velocity, Vec2(0, 0));
  const std::vector<Vec2> one = {{5, 5}};
  EXPECT_EQ(filter.estimate(one).velocity, Vec2(0, 0));
}

TEST(ObservationNoise, IsSmallOnSmoothTracksAndFindsAZigzag) {
  ObservationNoise smooth, rough;
  for (int agent = 0; agent < 40; ++agent) {
    std::vector<Vec2> a, b;
    for (int k = 0; k < 5; ++k) {
      a.push_back({0.4 * k + 0.02 * k * k, 0.1 * k});
      b.push_back(a.back() + Vec2(0, (k + agent) % 2 == 0 ? 0.05 : -0.05));
    }
    smooth.add(a);
    rough.add(b);
  }
  smooth.update();
  rough.update();
  EXPECT_LT(smooth.deviation(), 1e-9);
  EXPECT_GT(rough.deviation(), 0.03);
}

TEST(IntendedPath, KeepsFadesTurnsAndStops) {
  MotionEstimate motion;
  motion.velocity = {2, 0};
  motion.acceleration = {0.5, 0};
  motion.turn_rate = 0.2;
  const IntentionShape shape{
      .acceleration_decay = 1, .speed_decay = 0, .turn_decay = 2, .stop_time = 1};
  std::array<Vec2, 12> keep, gain, turn, stop;
  const IntentionTimes times(shape, 0.4);
  intended_path(IntentionHypothesis::KeepVelocity, motion, times, keep);
  intended_path(IntentionHypothesis::KeepAcceleration, motion, times, gain);
  intended_path(IntentionHypothesis::ConstantTurnRate, motion, times, turn);
  intended_path(IntentionHypothesis::Stop, motion, times, stop);
  EXPECT_NEAR(keep[11].x(), 9.6, 1e-12);
  // the acceleration adds at most 0.5 m/s in the end
  EXPECT_NEAR(gain[11].x() - gain[10].x(), 0.4 * 2.5, 0.01);
  EXPECT_GT(turn[11].y(), 1.0);
  // 2 m/s lost over 1 s: 2 m
  EXPECT_NEAR(stop[11].x(), 2.0, 0.02);
}

}  // namespace
}  // namespace sumogamma
