#include "study/motion_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"

namespace sumogamma {
namespace {

TEST(DistributionDistance, IsZeroForEqualAndOneForDisjointOnes) {
  const std::vector<double> a{1, 2, 3, 0}, same{2, 4, 6, 0}, other{0, 0, 0, 5};
  const DistributionDistance none = distance_of(a, same, 0.5), all = distance_of(a, other, 0.5);
  EXPECT_NEAR(none.hellinger, 0.0, 1e-7);
  EXPECT_NEAR(none.jensen_shannon, 0.0, 1e-12);
  EXPECT_NEAR(none.wasserstein, 0.0, 1e-12);
  EXPECT_NEAR(none.kolmogorov_smirnov, 0.0, 1e-12);
  EXPECT_NEAR(all.hellinger, 1.0, 1e-12);
  EXPECT_NEAR(all.jensen_shannon, 1.0, 1e-12);
  EXPECT_NEAR(all.kolmogorov_smirnov, 1.0, 1e-12);
  // 1/6 goes three bins, 2/6 two, 3/6 one
  EXPECT_NEAR(all.wasserstein, 0.5 * (3.0 / 6 + 4.0 / 6 + 3.0 / 6), 1e-12);
}

TEST(DistributionDistance, OfTwoHalvesIsInClosedForm) {
  // p = (1/2, 1/2), q = (1, 0)
  const std::vector<double> p{1, 1}, q{3, 0};
  const DistributionDistance distance = distance_of(p, q, 1.0);
  EXPECT_NEAR(distance.hellinger, std::sqrt(1.0 - std::sqrt(0.5)), 1e-12);
  // entropy of (3/4, 1/4) less half of one bit
  const double entropy = -0.75 * std::log2(0.75) - 0.25 * std::log2(0.25);
  EXPECT_NEAR(distance.jensen_shannon, entropy - 0.5, 1e-12);
  EXPECT_NEAR(distance.kolmogorov_smirnov, 0.5, 1e-12);
  EXPECT_NEAR(distance.wasserstein, 0.5, 1e-12);
}

std::vector<AgentHistogram> agents_of(std::uint64_t seed, double shift, const Bins& bins) {
  std::vector<AgentHistogram> agents;
  for (std::uint32_t agent = 0; agent < 60; ++agent) {
    AgentHistogram counts{agent % 3, std::vector<float>(bins.count, 0.0F)};
    for (std::uint64_t k = 0; k < 20; ++k)
      counts.counts[bins.index(shift + random_normal(seed, agent, k, Draw::Demand))] += 1.0F;
    agents.push_back(std::move(counts));
  }
  return agents;
}

TEST(EstimateDistance, TellsADifferenceFromChance) {
  const Bins bins{-6, 6, 24};
  const auto a = agents_of(1, 0.0, bins), b = agents_of(2, 0.0, bins), c = agents_of(3, 1.0, bins);
  const DistanceEstimate same = estimate_distance(a, b, bins, 100, 7);
  EXPECT_LT(same.value.wasserstein, same.chance.wasserstein);
  const DistanceEstimate differs = estimate_distance(a, c, bins, 100, 7);
  EXPECT_GT(differs.value.wasserstein, 3 * differs.chance.wasserstein);
  EXPECT_NEAR(differs.value.wasserstein, 1.0, 0.1);
  EXPECT_LE(differs.low.wasserstein, differs.value.wasserstein);
  EXPECT_GE(differs.high.wasserstein, differs.value.wasserstein);
  // the same draws for the same seed
  EXPECT_EQ(estimate_distance(a, c, bins, 100, 7).low.hellinger, differs.low.hellinger);
  EXPECT_FALSE(estimate_distance(a, {}, bins, 100, 7).known);
}

/// The bin that holds all of an agent's values, or -1.
int only_bin(const AgentHistogram& agent) {
  int bin = -1;
  for (std::size_t k = 0; k < agent.counts.size(); ++k)
    if (agent.counts[k] > 0.0F) bin = bin < 0 ? static_cast<int>(k) : -2;
  return bin;
}

// [A]-> 10 m/s  [B]-> 10 m/s, 15 m apart, brakes or turns as told
class Samples : public ::testing::Test {
 protected:
  void SetUp() override {
    for (std::uint32_t id = 0; id < 2; ++id) {
      AgentState agent;
      agent.id = AgentId{id};
      agent.type = find_agent_type(types_, id == 0 ? "car" : "bus");
      agent.footprint = box_footprint(4.0, 2.0);
      agent.position = {19.0 * id, 0};
      append_agent(scene_, agent);
      scene_.velocity.back() = {10, 0};
    }
  }
  void run(MotionSampler& sampler, int frames, double brakes) {
    sampler.begin_group(0.5);
    for (int frame = 0; frame < frames; ++frame) {
      scene_.time = 0.5 * frame;
      sampler.add(scene_, types_);
      for (std::size_t row = 0; row < 2; ++row) {
        scene_.position[row] += 0.5 * scene_.velocity[row];
        scene_.velocity[row].x() -= 0.5 * brakes;
      }
    }
    sampler.finish();
  }
  AgentTypeTable types_ = default_agent_types();
  Scene scene_;
};

TEST_F(Samples, OfFollowing) {
  MotionSampler sampler;
  run(sampler, 6, 0.0);
  ASSERT_EQ(sampler.agents(MotionMeasure::Speed).size(), 2u);
  const auto& measures = motion_measures();
  const auto bin = [&](MotionMeasure measure, double value) {
    return static_cast<int>(measures[static_cast<std::size_t>(measure)].bins.index(value));
  };
  EXPECT_EQ(only_bin(sampler.agents(MotionMeasure::Speed)[0]), bin(MotionMeasure::Speed, 10.0));
  EXPECT_EQ(only_bin(sampler.agents(MotionMeasure::NearestDistance)[1]),
            bin(MotionMeasure::NearestDistance, 15.0));
  // 15 m at 10 m/s, of who follows alone
  ASSERT_EQ(sampler.agents(MotionMeasure::TimeGap).size(), 1u);
  EXPECT_EQ(only_bin(sampler.agents(MotionMeasure::TimeGap)[0]), bin(MotionMeasure::TimeGap, 1.5));
  EXPECT_TRUE(sampler.agents(MotionMeasure::TimeToCollision).empty());
  EXPECT_EQ(only_bin(sampler.agents(MotionMeasure::YawRate)[0]), bin(MotionMeasure::YawRate, 0.0));
}

TEST_F(Samples, OfBrakingAndOfOneTypeAlone) {
  MotionSampler sampler({"bus"});
  run(sampler, 5, 2.0);
  EXPECT_EQ(sampler.sampled_agents(), 1u);
  const Bins bins = motion_measures()[static_cast<std::size_t>(MotionMeasure::Acceleration)].bins;
  EXPECT_EQ(only_bin(sampler.agents(MotionMeasure::Acceleration)[0]),
            static_cast<int>(bins.index(-2.0)));
}

TEST_F(Samples, OfCrossingHaveAnEncroachment) {
  // B comes from the side, 4 s behind A
  scene_.position[0] = {0, 0};
  scene_.position[1] = {5, -50};
  scene_.heading[1] = radians(90.0);
  scene_.velocity[1] = {0, 10};
  MotionSampler sampler;
  run(sampler, 16, 0.0);
  ASSERT_EQ(sampler.agents(MotionMeasure::PostEncroachment).size(), 1u);
}

}  // namespace
}  // namespace sumogamma
