#include "inference/belief.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "base/random.h"
#include "inference/behavior_filter.h"

namespace sumogamma {
namespace {

double sum_of(const HypothesisWeights<kIntentions>& histogram) {
  const auto weights = histogram.weights();
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

TEST(BeliefProperty, SumsToOneWhateverIsObserved) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    FilterParameters parameters;
    parameters.intention_prior = {0.5, 1, 0, 0.1};
    parameters.change_of_mind = 0.05;
    Belief belief = initial_belief(parameters);
    for (std::uint64_t tick = 0; tick < 50; ++tick) {
      Expectation expectation;
      expectation.valid = true;
      for (std::size_t k = 0; k < kIntentions; ++k)
        expectation.by_intention[k] = {random_uniform(seed, k, tick, Draw::Intention, -50, 50), 0};
      update_belief(parameters, expectation, {0, 0}, 0.02, belief);
      EXPECT_NEAR(sum_of(belief.intention), 1.0, 1e-9);
      EXPECT_EQ(belief.intention.weights()[2], 0.0);  // ruled out by the prior
    }
  }
}

TEST(BeliefProperty, OrderOfObservationsDoesNotMatterWithoutAChangeOfMind) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    HypothesisWeights<4> forwards = HypothesisWeights<4>::from({1, 2, 3, 4}), backwards = forwards;
    std::array<std::array<double, 4>, 5> seen{};
    for (std::uint64_t t = 0; t < 5; ++t)
      for (std::uint64_t k = 0; k < 4; ++k)
        seen[t][k] = random_uniform(seed, k, t, Draw::Intention, -5, 0);
    for (std::size_t t = 0; t < 5; ++t) {
      forwards.update(seen[t]);
      backwards.update(seen[4 - t]);
    }
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(forwards.weights()[k], backwards.weights()[k], 1e-12);
  }
}

TEST(Belief, FindsTheHypothesisThatFits) {
  FilterParameters parameters;
  parameters.intention_prior = {1, 1, 1, 1};
  parameters.deviation = 0.05;
  Belief belief = initial_belief(parameters);
  Expectation expectation;
  expectation.valid = true;
  for (std::size_t k = 0; k < kIntentions; ++k)
    expectation.by_intention[k] = {0.1 * static_cast<double>(k), 0};
  for (int tick = 0; tick < 10; ++tick) update_belief(parameters, expectation, {0.2, 0}, 0, belief);
  EXPECT_EQ(belief.intention.most_likely(), 2u);
  EXPECT_GT(belief.intention.weights()[2], 0.9);
  // and a change of mind is seen within a few ticks
  for (int tick = 0; tick < 4; ++tick) update_belief(parameters, expectation, {0.0, 0}, 0, belief);
  EXPECT_EQ(belief.intention.most_likely(), 0u);
}

TEST(Belief, SurvivesThousandsOfUnlikelyTicks) {
  FilterParameters parameters;
  Belief belief = initial_belief(parameters);
  Expectation expectation;
  expectation.valid = true;
  for (int tick = 0; tick < 5000; ++tick)
    update_belief(parameters, expectation, {1e6, 1e6}, 0, belief);
  EXPECT_NEAR(sum_of(belief.intention), 1.0, 1e-9);
}

TEST(Belief, IsNotMovedByWhatIsNoNumber) {
  HypothesisWeights<4> belief = HypothesisWeights<4>::from({1, 2, 3, 4});
  const auto before = belief.weights();
  belief.update({std::numeric_limits<double>::quiet_NaN(), 0, 0, 0});
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(belief.weights()[k], before[k], 1e-15);
}

}  // namespace
}  // namespace sumogamma
