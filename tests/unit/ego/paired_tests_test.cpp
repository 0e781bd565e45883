#include "ego/paired_tests.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace sumogamma {
namespace {

TEST(McNemar, IsThatOfTheBooks) {
  // 1 against 8 of one kind alone: exact two-sided 20 / 512, less the share of that very table
  EXPECT_NEAR(mcnemar_mid_p({0, 1, 8, 11}), 20.0 / 512.0 - 9.0 / 512.0, 1e-12);
  EXPECT_EQ(mcnemar_mid_p({5, 0, 0, 5}), 1.0);
  EXPECT_NEAR(mcnemar_mid_p({0, 3, 3, 0}), 1.0, 0.05);
  EXPECT_EQ(mcnemar_mid_p({0, 9, 2, 0}), mcnemar_mid_p({0, 2, 9, 0})) << "two-sided";
}

TEST(PairedDifference, TurnsItsSignWithItsSides) {
  const IntervalEstimate one = paired_difference({20, 12, 2, 16}),
                         other = paired_difference({20, 2, 12, 16});
  EXPECT_NEAR(one.value, 0.2, 1e-12);
  EXPECT_NEAR(one.low, -other.high, 1e-12);
  EXPECT_NEAR(one.high, -other.low, 1e-12);
  EXPECT_LT(one.low, one.value);
  EXPECT_GT(one.high, one.value);
  EXPECT_EQ(paired_difference({}).low, -1.0);
}

TEST(PairedDifference, PairsThatGoTogetherTellMore) {
  // the same shares, 22 and 12 of 50, with hardly any and with all of the second within the first
  const IntervalEstimate apart = paired_difference({5, 17, 7, 21}),
                         together = paired_difference({12, 10, 0, 28});
  EXPECT_NEAR(apart.value, together.value, 1e-12);
  EXPECT_LT(together.high - together.low, apart.high - apart.low);
}

TEST(PairedDifference, CoversADifferenceThatIsKnown) {
  constexpr double kBoth = 0.1, kFirst = 0.15, kSecond = 0.05;
  int covered = 0;
  constexpr std::uint64_t kRuns = 400;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    PairedCounts counts;
    for (std::uint64_t k = 0; k < 100; ++k) {
      const double draw = random_uniform(run, k, 0, Draw::ProcessNoise);
      ++(draw < kBoth                      ? counts.both
         : draw < kBoth + kFirst           ? counts.first
         : draw < kBoth + kFirst + kSecond ? counts.second
                                           : counts.neither);
    }
    const IntervalEstimate difference = paired_difference(counts);
    covered += difference.low <= kFirst - kSecond && kFirst - kSecond <= difference.high;
  }
  EXPECT_GE(covered, 368);  // 95 % of 400, less three deviations
}

TEST(Bootstrap, CoversAMeanThatIsKnown) {
  int covered = 0, rejected = 0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> values;
    for (std::uint64_t k = 0; k < 40; ++k)
      values.push_back(random_normal(static_cast<std::uint64_t>(run), k, 0, Draw::ProcessNoise));
    const IntervalEstimate mean = bootstrap_mean(values, 7);
    covered += mean.low <= 0.0 && 0.0 <= mean.high;
    rejected += bootstrap_p(values, 7) < 0.05;
  }
  EXPECT_GE(covered, 33);  // 38 of 40 are expected, with a deviation of 1.4
  EXPECT_LE(rejected, 7);
}

TEST(Bootstrap, IsAFunctionOfItsKey) {
  const std::vector<double> values{1, 2, 3, 10};
  EXPECT_EQ(bootstrap_mean(values, 3).low, bootstrap_mean(values, 3).low);
  EXPECT_EQ(bootstrap_mean(values, 3).value, 4.0);
  EXPECT_LT(bootstrap_p(std::vector<double>{1, 1.5, 2, 1.2, 1.1, 1.8}, 3), 0.001);
  const std::vector<double> one{5};
  EXPECT_EQ(bootstrap_mean(one, 1).high, 5.0);
  EXPECT_EQ(bootstrap_p(one, 1), 1.0);
}

TEST(Holm, AdjustsStepByStep) {
  const std::vector<double> adjusted = holm(std::vector<double>{0.04, 0.01, 0.03, 0.005});
  EXPECT_NEAR(adjusted[3], 0.02, 1e-12);
  EXPECT_NEAR(adjusted[1], 0.03, 1e-12);
  EXPECT_NEAR(adjusted[2], 0.06, 1e-12);
  EXPECT_NEAR(adjusted[0], 0.06, 1e-12) << "never below a smaller one's";
}

}  // namespace
}  // namespace sumogamma
