#include "realism/likelihood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "realism/motion_counts.h"
#include "realism/score.h"

namespace sumogamma {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(Likelihood, IsOfAHistogramWithPseudoCounts) {
  // three in the first of two bins, one in the second: 3.1 and 1.1 of 4.2
  const std::vector<double> rollouts{0.1, 0.2, kNone, 0.3, 0.9};
  const Bins bins{0, 1, 2};
  EXPECT_NEAR(mean_log_likelihood(std::vector{0.4}, rollouts, bins), std::log(3.1 / 4.2), 1e-12);
  EXPECT_NEAR(mean_log_likelihood(std::vector{0.4, kNone, 7.0}, rollouts, bins),
              0.5 * (std::log(3.1 / 4.2) + std::log(1.1 / 4.2)), 1e-12);
  EXPECT_TRUE(std::isnan(mean_log_likelihood(std::vector{kNone}, rollouts, bins)));
  EXPECT_TRUE(std::isnan(mean_log_likelihood(std::vector{0.4}, std::vector{kNone}, bins)));
}

TEST(Likelihood, OfCollisionsIsTheShareOfRollouts) {
  EXPECT_NEAR(event_log_likelihood(false, 8, 32), std::log(24.001 / 32.002), 1e-12);
  EXPECT_NEAR(event_log_likelihood(true, 8, 32), std::log(8.001 / 32.002), 1e-12);
  EXPECT_NEAR(std::exp(event_log_likelihood(true, 0, 1)), 0.001 / 1.002, 1e-12);
}

TEST(Likelihood, WeightsAreThoseOf2025) {
  double all = 0, without_map = 0;
  for (const ScoreFeatureInfo& info : score_features()) {
    all += info.weight;
    without_map += info.feature < ScoreFeature::RoadEdge ? info.weight : 0.0;
  }
  EXPECT_NEAR(all, 1.0, 1e-12);
  EXPECT_NEAR(without_map, 0.65, 1e-12);
}

TEST(Likelihood, CompositeIsTheWeightedMeanOfGeometricMeans) {
  ScoreSums sums;
  for (std::size_t k = 0; k < kScoreFeatures; ++k) {
    sums.log_likelihood[k] = std::log(0.9) + std::log(0.4);
    sums.agents[k] = 2;
  }
  const ScoreFigures even = figures_of(sums);
  EXPECT_NEAR(even.composite, 0.6, 1e-12);
  EXPECT_NEAR(even.kinematic, 0.6, 1e-12);
  sums.log_likelihood[static_cast<std::size_t>(ScoreFeature::Collision)] = 0.0;
  EXPECT_NEAR(figures_of(sums).composite, 0.75 * 0.6 + 0.25, 1e-12);
  // without a map the weights of the others make up for those of its features
  for (std::size_t k = 0; k < kScoreFeatures; ++k)
    if (score_features()[k].feature >= ScoreFeature::RoadEdge) sums.agents[k] = 0;
  EXPECT_NEAR(figures_of(sums).composite, (0.4 * 0.6 + 0.25) / 0.65, 1e-12);
}

TEST(MotionCounts, HellingerIsNullForTheSameAndOneForOthers) {
  MotionCounts a, b;
  a.counts[0][3] = 5;
  b.counts[0][3] = 50;
  EXPECT_NEAR(hellinger(a, b)[0], 0.0, 1e-9);
  EXPECT_TRUE(std::isnan(hellinger(a, b)[1]));
  b.counts[0][3] = 0;
  b.counts[0][4] = 2;
  EXPECT_NEAR(hellinger(a, b)[0], 1.0, 1e-12);
  EXPECT_TRUE(noise_floor({a}).empty());
  EXPECT_NEAR(noise_floor({a, a, b})[0], 2.0 / 3.0, 1e-12);
}

//          |B  2 m/s, is 1 s later where A was
//   [A> 4 m/s
TEST(MotionCounts, WhoCrossesBehindAnotherEncroaches) {
  Poses poses(2);
  for (std::size_t k = 0; k < Poses::kSteps; ++k) {
    const double time = 0.1 * static_cast<double>(k);
    poses.position[k] = {-10.0 + 4.0 * time, 0.0};
    poses.position[Poses::kSteps + k] = {0.0, -10.0 + 2.0 * time};
    poses.heading[Poses::kSteps + k] = 1.5707963;
  }
  const Bodies bodies{{Vec2(4, 2), Vec2(1, 1)}, {Poses::kSteps, Poses::kSteps}};
  MotionCounts counts;
  counts.add_encroachments(poses, bodies);
  EXPECT_EQ(counts.total(CountedMeasure::PostEncroachment), 1.0);
  // A's rear leaves what B takes at (10 + 2 + .5) / 4 s; B's front comes at (10 - 1 - .5) / 2 s
  const double pet = 8.5 / 2.0 - 12.5 / 4.0;
  EXPECT_EQ(counts.counts[6][static_cast<std::size_t>(pet)], 1.0) << pet;
}

TEST(ScoreMethods, AnUnknownOneIsToldTheNearest) {
  try {
    require_score_method("gama");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean gamma?"), std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(require_score_method("cv-fan"));
}

}  // namespace
}  // namespace sumogamma
