#include "realism/motion_features.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sumogamma {
namespace {

constexpr std::size_t kSteps = Poses::kSteps;

/// Row `row` goes from `from` along `heading`, first at `speed`, faster by `acceleration`, turning
/// at `turn`.
struct Way {
  Vec2 from = Vec2::Zero();
  double heading = 0, speed = 0, acceleration = 0, turn = 0;
};

Poses poses_of(const std::vector<Way>& ways) {
  Poses poses(ways.size());
  for (std::size_t row = 0; row < ways.size(); ++row)
    for (std::size_t k = 0; k < kSteps; ++k) {
      const Way& way = ways[row];
      const double time = kScoreStep * static_cast<double>(k);
      const double along = way.speed * time + 0.5 * way.acceleration * time * time;
      poses.position[row * kSteps + k] = way.from + along * direction_of(way.heading);
      poses.heading[row * kSteps + k] = way.heading + way.turn * time;
    }
  return poses;
}

Bodies cars(std::size_t count) {
  return {std::vector<Vec2>(count, Vec2(4.0, 2.0)), std::vector<std::size_t>(count, kSteps)};
}

TEST(MotionFeatures, AreAnalyticForAnAcceleratingTurningBody) {
  const MotionFeatures features = features_of(poses_of({{{0, 0}, 0.5, 3.0, 1.5, 0.2}}), cars(1));
  EXPECT_TRUE(std::isnan(features.speed[0]));
  EXPECT_TRUE(std::isnan(features.acceleration[1]));
  EXPECT_TRUE(std::isnan(features.speed[kSteps - 1]));
  EXPECT_NEAR(features.speed[20], 3.0 + 1.5 * 2.0, 1e-9);
  EXPECT_NEAR(features.acceleration[20], 1.5, 1e-9);
  EXPECT_NEAR(features.yaw_rate[20], 0.2, 1e-9);
  EXPECT_NEAR(features.yaw_acceleration[20], 0.0, 1e-9);
  // alone: the ends of the bins
  EXPECT_EQ(features.nearest[20], 40.0);
  EXPECT_EQ(features.time_to_collision[20], 5.0);
  EXPECT_TRUE(std::isinf(features.gap[20]));
}

TEST(MotionFeatures, TurnThroughHalfATurnWithoutAJump) {
  const MotionFeatures features = features_of(poses_of({{{0, 0}, 3.0, 0.0, 0.0, 0.3}}), cars(1));
  for (std::size_t k = 1; k + 1 < kSteps; ++k) EXPECT_NEAR(features.yaw_rate[k], 0.3, 1e-9);
}

//   [A>  10 m/s     30 m     [B>  4 m/s
TEST(MotionFeatures, TimeToCollisionIsGapOverClosingSpeed) {
  const MotionFeatures features =
      features_of(poses_of({{{0, 0}, 0, 10, 0, 0}, {{30, 0}, 0, 4, 0, 0}}), cars(2));
  for (const std::size_t k : {10u, 20u, 30u}) {
    const double gap = 30.0 - 4.0 - 6.0 * 0.1 * static_cast<double>(k);
    EXPECT_NEAR(features.gap[k], gap, 1e-9);
    EXPECT_NEAR(features.nearest[k], gap, 1e-9);
    EXPECT_NEAR(features.time_to_collision[k], std::min(5.0, gap / 6.0), 1e-9);
    EXPECT_EQ(features.time_to_collision[kSteps + k], 5.0) << "who is followed follows nobody";
  }
}

//        [B>          B stands 1.9 m (they overlap by .1 m), 2.5 m aside, or across
//   [A>
TEST(MotionFeatures, AheadIsWhomTheOwnStripMeets) {
  const auto soonest = [](double aside, double heading) {
    return features_of(poses_of({{{0, 0}, 0, 5, 0, 0}, {{14, aside}, heading, 0, 0, 0}}), cars(2))
        .time_to_collision[1];
  };
  EXPECT_NEAR(soonest(1.9, 0.0), (14.0 - 4.0 - 0.5) / 5.0, 1e-9);
  EXPECT_EQ(soonest(2.5, 0.0), 5.0);
  EXPECT_EQ(soonest(0.0, 1.4), 5.0) << "beyond 75 degrees nobody is followed";
  EXPECT_LT(soonest(0.0, 1.2), 2.0);
  // turned by 30 degrees and met by 0.4 m alone: not ahead; met by more: ahead
  const double breadth = 2.0 * std::sin(0.5236) + std::cos(0.5236);
  EXPECT_EQ(soonest(1.0 + breadth - 0.4, 0.5236), 5.0);
  EXPECT_LT(soonest(1.0 + breadth - 0.6, 0.5236), 5.0);
}

TEST(MotionFeatures, NearestIsNegativeWhereBoxesOverlap) {
  const MotionFeatures features = features_of(
      poses_of({{{0, 0}, 0, 0, 0, 0}, {{3.5, 0}, 0, 0, 0, 0}, {{0, 52}, 0, 0, 0, 0}}), cars(3));
  EXPECT_NEAR(features.nearest[5], -0.5, 1e-9);
  EXPECT_NEAR(features.nearest[kSteps + 5], -0.5, 1e-9);
  EXPECT_EQ(features.nearest[2 * kSteps + 5], 40.0) << "beyond 50 m nobody counts";
  // corner to corner: 3 and 4 m
  EXPECT_NEAR(signed_distance({{0, 0}, {0, 0}, 0}, {4, 2}, {{7, 6}, {0, 0}, 0}, {4, 2}), 5.0, 1e-9);
}

TEST(MotionFeatures, EndWithTheBody) {
  Bodies bodies = cars(2);
  bodies.present[1] = 30;
  const MotionFeatures features =
      features_of(poses_of({{{0, 0}, 0, 1, 0, 0}, {{20, 0}, 0, 1, 0, 0}}), bodies);
  EXPECT_NEAR(features.nearest[29], 16.0, 1e-9);
  EXPECT_EQ(features.nearest[30], 40.0);
  EXPECT_TRUE(std::isnan(features.nearest[kSteps + 30]));
  EXPECT_TRUE(std::isnan(features.speed[kSteps + 29]));
  EXPECT_FALSE(std::isnan(features.speed[kSteps + 28]));
}

}  // namespace
}  // namespace sumogamma
