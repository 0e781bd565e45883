#include "base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <set>

namespace sumogamma {
namespace {

constexpr std::uint64_t kAgents = 200;
constexpr std::uint64_t kTicks = 500;
constexpr auto kDraws = static_cast<double>(kAgents * kTicks);

// the stream is part of what "same seed, same bytes" promises across versions: a change here
// changes every result
TEST(Random, StreamIsFixedForEver) {
  static_assert(random_bits(1, 2, 3, Draw::Attention) == random_bits(1, 2, 3, Draw::Attention));
  EXPECT_EQ(random_bits(0, 0, 0, Draw::Responsibility), 0x2a4f111b3be57715ULL);
  EXPECT_EQ(random_bits(1, 2, 3, Draw::Attention), 0xa60facfa74e65895ULL);
  EXPECT_EQ(random_bits(~0ULL, ~0ULL, ~0ULL, Draw::Jaywalking), 0xcc876f654ec7192cULL);
}

TEST(Random, EachArgumentHasItsOwnStream) {
  std::set<std::uint64_t> seen;
  std::size_t drawn = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed)
    for (std::uint64_t agent = 0; agent < 16; ++agent)
      for (std::uint64_t tick = 0; tick < 16; ++tick)
        for (std::uint32_t purpose = 1; purpose <= 10; ++purpose, ++drawn)
          seen.insert(random_bits(seed, agent, tick, static_cast<Draw>(purpose)));
  EXPECT_EQ(seen.size(), drawn);
}

TEST(Random, UniformStaysBelowOneAndFillsItsBinsEvenly) {
  std::array<double, 20> bins{};
  for (std::uint64_t agent = 0; agent < kAgents; ++agent) {
    for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
      const double value = random_uniform(7, agent, tick, Draw::DesiredSpeed);
      ASSERT_GE(value, 0.0);
      ASSERT_LT(value, 1.0);
      bins[static_cast<std::size_t>(value * 20.0)] += 1.0;
    }
  }
  double chi_square = 0.0;
  for (const double count : bins) {
    const double expected = kDraws / 20.0;
    chi_square += (count - expected) * (count - expected) / expected;
  }
  EXPECT_LT(chi_square, 43.8);  // 19 degrees of freedom, p = 0.001
}

TEST(Random, UniformOfAnIntervalStaysInIt) {
  for (std::uint64_t agent = 0; agent < 1000; ++agent) {
    const double value = random_uniform(3, agent, 0, Draw::Headway, -2.0, 5.0);
    ASSERT_GE(value, -2.0);
    ASSERT_LT(value, 5.0);
  }
  EXPECT_EQ(random_uniform(3, 1, 0, Draw::Headway, 4.0, 4.0), 4.0);
}

TEST(Random, NormalHasMeanZeroVarianceOneAndNoMemory) {
  double sum = 0.0, squares = 0.0, lagged = 0.0, previous = 0.0, within_one = 0.0;
  for (std::uint64_t agent = 0; agent < kAgents; ++agent) {
    for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
      const double value = random_normal(11, agent, tick, Draw::ProcessNoise);
      ASSERT_LE(std::abs(value), 6.0);
      sum += value;
      squares += value * value;
      lagged += value * previous;
      within_one += std::abs(value) < 1.0 ? 1.0 : 0.0;
      previous = value;
    }
  }
  // bounds are four standard errors of 100 000 draws
  EXPECT_NEAR(sum / kDraws, 0.0, 0.013);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.018);
  EXPECT_NEAR(lagged / kDraws, 0.0, 0.013);
  EXPECT_NEAR(within_one / kDraws, 0.6778,
              0.01);  // the sum of 12 uniforms; the exact normal has 0.6827
}

}  // namespace
}  // namespace sumogamma
