#include "ego/closed_loop_score.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ego/ego_metrics.h"

namespace sumogamma {
namespace {

constexpr double kStep = 0.05;  // [s]

/// Straight on at `speed` [m/s] for ten seconds, 50 m with 5 m/s, and nobody about.
std::vector<EgoSample> straight_on(double speed = 5.0) {
  std::vector<EgoSample> samples;
  for (int k = 1; k <= 200; ++k) {
    EgoSample sample;
    sample.time = kStep * k;
    sample.position = Vec2(speed * sample.time, 0);
    sample.speed = speed;
    sample.progress = speed * kStep;
    sample.limit = 10;
    samples.push_back(sample);
  }
  return samples;
}

ClosedLoopScore score_of(const std::vector<EgoSample>& samples,
                         const std::optional<EgoContact>& contact = {}, double reference = 50) {
  return closed_loop_score(samples, contact, reference, kStep);
}

EgoContact contact(ContactKind kind, bool in_one_lane = true) {
  EgoContact contact;
  contact.kind = kind;
  contact.in_one_lane = in_one_lane;
  return contact;
}

TEST(ClosedLoopScore, IsOneWhereNothingIsWrong) {
  const ClosedLoopScore score = score_of(straight_on());
  EXPECT_DOUBLE_EQ(score.total(), 1.0);
  EXPECT_DOUBLE_EQ(score.without_comfort(), 1.0);
}

TEST(ClosedLoopScore, IsNullAfterAContactAtFaultAlone) {
  for (const ContactKind kind : {ContactKind::Front, ContactKind::OtherStood}) {
    EXPECT_EQ(score_of(straight_on(), contact(kind)).no_fault, 0.0);
    EXPECT_EQ(score_of(straight_on(), contact(kind)).total(), 0.0);
  }
  for (const ContactKind kind : {ContactKind::Standing, ContactKind::FromBehind, ContactKind::Side})
    EXPECT_EQ(score_of(straight_on(), contact(kind)).total(), 1.0);
  EXPECT_EQ(score_of(straight_on(), contact(ContactKind::Side, false)).total(), 0.0);
}

TEST(ClosedLoopScore, IsNullWhereACornerWasOffTheRoad) {
  auto samples = straight_on();
  samples[77].off_area = true;
  EXPECT_EQ(score_of(samples).drivable_area, 0.0);
  EXPECT_EQ(score_of(samples).total(), 0.0);
}

TEST(ClosedLoopScore, IsNullAfterMoreThanAMetreAgainstTheLaneWithinASecond) {
  auto samples = straight_on();
  for (std::size_t k = 0; k < 20; ++k) samples[2 * k].against = 0.099;  // 0.99 m in any second
  EXPECT_EQ(score_of(samples).driving_direction, 1.0);
  for (std::size_t k = 100; k < 111; ++k) samples[k].against = 0.1;
  EXPECT_EQ(score_of(samples).driving_direction, 0.0);
  EXPECT_EQ(score_of(samples).total(), 0.0);
}

TEST(ClosedLoopScore, IsNullWhereItHardlyGotOn) {
  EXPECT_EQ(score_of(straight_on(), {}, 249.0).making_progress, 1.0);
  const ClosedLoopScore little = score_of(straight_on(), {}, 251.0);
  EXPECT_EQ(little.making_progress, 0.0);
  EXPECT_EQ(little.total(), 0.0);
}

TEST(ClosedLoopScore, WeighsTimeToCollisionAtFiveSixteenths) {
  auto samples = straight_on();
  samples[3].time_to_collision = 0.96;
  EXPECT_EQ(score_of(samples).time_to_collision, 1.0);
  samples[3].time_to_collision = 0.94;
  EXPECT_EQ(score_of(samples).time_to_collision, 0.0);
  EXPECT_DOUBLE_EQ(score_of(samples).total(), 11.0 / 16.0);
  EXPECT_DOUBLE_EQ(score_of(samples).without_comfort(), 9.0 / 14.0);
}

TEST(ClosedLoopScore, WeighsProgressAtFiveSixteenths) {
  const ClosedLoopScore half = score_of(straight_on(), {}, 100.0);
  EXPECT_NEAR(half.progress, 0.5, 1e-12);
  EXPECT_NEAR(half.total(), (11.0 + 5.0 * 0.5) / 16.0, 1e-12);
  EXPECT_EQ(score_of(straight_on(), {}, 10.0).progress, 1.0) << "no more than all of it";
  EXPECT_EQ(score_of(straight_on(0.0), {}, 0.0).progress, 1.0) << "0.1 m of 0.1 m";
}

TEST(ClosedLoopScore, WeighsTheSpeedLimitAtFourSixteenths) {
  auto samples = straight_on();
  for (std::size_t k = 0; k < 100; ++k)
    samples[k].limit = 5.0 - 1.115;  // half of 2.23, half the time
  const ClosedLoopScore score = score_of(samples);
  EXPECT_NEAR(score.speed_limit, 0.75, 1e-9);
  EXPECT_NEAR(score.total(), (12.0 + 4.0 * 0.75) / 16.0, 1e-9);
  for (EgoSample& sample : samples) sample.limit = 1.0;
  EXPECT_EQ(score_of(samples).speed_limit, 0.0) << "never below 0";
}

/// Samples of a body that accelerates along its heading as `acceleration` says.
template <typename Acceleration>
std::vector<EgoSample> moving(Acceleration&& acceleration) {
  auto samples = straight_on();
  double speed = 5.0, place = 0.0;
  for (EgoSample& sample : samples) {
    speed += kStep * acceleration(sample.time);
    place += kStep * speed;
    sample.speed = speed;
    sample.position = Vec2(place, 0);
    sample.limit = 100.0;  // comfort alone
  }
  return samples;
}

TEST(ClosedLoopScore, WeighsComfortAtTwoSixteenths) {
  // a slow swell: 2 m/s^2, jerk 2 pi / 5 * 2
  const auto gentle = moving([](double time) { return 2.0 * std::sin(2.0 * M_PI * time / 5.0); });
  EXPECT_EQ(score_of(gentle).comfort, 1.0);
  const auto harsh = moving([](double time) { return time < 3.0 ? 0.0 : 3.0; });
  EXPECT_EQ(score_of(harsh).comfort, 0.0);
  EXPECT_NEAR(score_of(harsh).total(), 14.0 / 16.0, 1e-9);
  EXPECT_NEAR(score_of(harsh).without_comfort(), 1.0, 1e-9);
}

TEST(ClosedLoopScore, ComfortHasABoundOfEachKind) {
  // a sample's motion, and whether it is comfortable, by turning and sliding a straight one
  const auto turning = [](double rate) {
    auto samples = straight_on();
    for (EgoSample& sample : samples) sample.heading = rate * sample.time;
    for (EgoSample& sample : samples) sample.position = Vec2::Zero();
    return samples;
  };
  EXPECT_EQ(score_of(turning(0.9)).comfort, 1.0);
  EXPECT_EQ(score_of(turning(1.0)).comfort, 0.0) << "yaw rate";
  auto jolt = turning(0.0);
  for (std::size_t k = 100; k < jolt.size(); ++k) jolt[k].heading = 0.5 * (jolt[k].time - 5.0);
  EXPECT_EQ(score_of(jolt).comfort, 0.0) << "yaw acceleration";
  // round a circle of 5 m radius: v^2 / r
  const auto circling = [](double speed) {
    auto samples = straight_on();
    for (EgoSample& sample : samples) {
      const double angle = speed * sample.time / 30.0;
      sample.heading = angle;
      sample.position = 30.0 * Vec2(std::sin(angle), 1.0 - std::cos(angle));
    }
    return samples;
  };
  EXPECT_EQ(score_of(circling(11.9)).comfort, 1.0);
  EXPECT_EQ(score_of(circling(12.3)).comfort, 0.0) << "lateral acceleration";
}

TEST(ClosedLoopScore, AnEpisodeThatNeverBeganMadeNoProgress) {
  EXPECT_EQ(score_of({}).total(), 0.0);
}

TEST(EgoMetrics, AreThoseOfAHandMadeEpisode) {
  // two seconds at 5 m/s, then braking by 3 m/s^2 for a second, then 2 m/s
  std::vector<EgoSample> samples = straight_on();
  double speed = 5.0, place = 0.0;
  for (EgoSample& sample : samples) {
    if (sample.time > 2.0 + 1e-9 && sample.time < 3.0 + 1e-9) speed -= 3.0 * kStep;
    place += speed * kStep;
    sample.speed = speed;
    sample.position = Vec2(place, 0);
    sample.progress = speed * kStep;
  }
  samples[10].gap = 0.7;
  samples[20].braking_others = 2;
  samples[30].delay_of_others = 0.04;
  const EgoMetrics metrics = metrics_of(samples, kStep, 0.5);
  EXPECT_NEAR(metrics.time, 9.95, 1e-9);
  EXPECT_NEAR(metrics.driven, place - 0.25, 1e-9);
  EXPECT_NEAR(metrics.progress, place, 1e-9);
  EXPECT_NEAR(metrics.mean_speed, metrics.driven / 9.95, 1e-9);
  EXPECT_EQ(metrics.least_gap, 0.7);
  EXPECT_NEAR(metrics.speed_change, 3.0 / metrics.driven, 1e-9);
  EXPECT_NEAR(metrics.acceleration, 3.0 / 9.95, 1e-9);
  EXPECT_NEAR(metrics.braking_of_others, 0.1, 1e-9);
  EXPECT_NEAR(metrics.delay_of_others, 0.04, 1e-9);
  EXPECT_NEAR(metrics.braking_share, 2.0 / 19.0, 1e-9);  // from 2 to 3 s
}

}  // namespace
}  // namespace sumogamma
