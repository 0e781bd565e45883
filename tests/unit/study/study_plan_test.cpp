#include "study/study_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "study/statistics.h"

namespace sumogamma {
namespace {

TEST(Grid, HasEveryCombinationOnce) {
  const std::vector<ParameterValues> parameters{{"a", {"1", "2"}}, {"b", {"x", "y", "z"}}};
  const auto grid = grid_of(parameters);
  ASSERT_EQ(grid.size(), 6u);
  std::set<std::string> seen;
  for (const auto& one : grid) seen.insert(one[0].value + one[1].value);
  EXPECT_EQ(seen.size(), 6u);
  EXPECT_EQ(grid[1][1].value, "y");
  EXPECT_EQ(grid_of({}).size(), 1u);
}

TEST(LatinHypercube, MeetsEveryPartOfEveryRangeOnce) {
  const std::vector<ParameterRange> ranges{{"a", 10, 20, false}, {"b", -1, 1, false}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const auto points = latin_hypercube(ranges, 8, seed);
    ASSERT_EQ(points.size(), 8u);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      std::set<int> parts;
      for (const auto& point : points) {
        const double share = (std::stod(point[axis].value) - ranges[axis].low) /
                             (ranges[axis].high - ranges[axis].low);
        parts.insert(static_cast<int>(std::floor(share * 8)));
      }
      EXPECT_EQ(parts.size(), 8u);
      EXPECT_GE(*parts.begin(), 0);
      EXPECT_LE(*parts.rbegin(), 7);
    }
  }
  EXPECT_EQ(latin_hypercube(ranges, 8, 3), latin_hypercube(ranges, 8, 3));
  EXPECT_NE(latin_hypercube(ranges, 8, 3), latin_hypercube(ranges, 8, 4));
}

TEST(LatinHypercube, KeepsWholeNumbersWhole) {
  const std::vector<ParameterRange> ranges{{"n", 1, 4, true}};
  std::multiset<std::string> values;
  for (const auto& point : latin_hypercube(ranges, 8, 1)) values.insert(point[0].value);
  for (const char* value : {"1", "2", "3", "4"}) EXPECT_EQ(values.count(value), 2u) << value;
}

Study small_study() {
  Study study;
  study.scenarios = {{"one", {}}, {"two", {}}};
  study.variants = {{"gamma", false, {}, {}}, {"plain", true, {}, {}}, {"third", false, {}, {}}};
  study.seeds = {1, 2, 3};
  return study;
}

TEST(StudyRuns, HaveAFolderEach) {
  const Study study = small_study();
  const auto runs = runs_of(study, study.seeds);
  ASSERT_EQ(runs.size(), 18u);
  std::set<std::string> all;
  for (const StudyRun& run : runs) EXPECT_TRUE(all.insert(folder_of(study, run).string()).second);
}

TEST(FolderName, IsAFolderAndTellsTextsApart) {
  EXPECT_EQ(folder_name("monaco"), "monaco");
  std::set<std::string> names;
  const std::vector<std::string> texts{
      "", ".", "..", "a b", "a/b", "a_b", "x/../../y", std::string(500, 'x'), std::string(501, 'x'),
      "ä"};
  for (const std::string& text : texts) {
    const std::string name = folder_name(text);
    EXPECT_TRUE(names.insert(name).second) << text;
    EXPECT_EQ(name.find('/'), std::string::npos);
    EXPECT_NE(name.front(), '.');
    EXPECT_LE(name.size(), 80u);
  }
}

TEST(StudentQuantile, IsThatOfTheTables) {
  EXPECT_NEAR(student_quantile(1, 0.975), 12.706, 1e-3);
  EXPECT_NEAR(student_quantile(2, 0.975), 4.303, 1e-3);
  EXPECT_NEAR(student_quantile(9, 0.975), 2.262, 1e-3);
  EXPECT_NEAR(student_quantile(1e6, 0.975), 1.960, 1e-3);
}

TEST(EstimateMean, HasStudentsInterval) {
  const std::vector<double> values{1, 2, 3, 4, 5};
  const Estimate estimate = estimate_mean(values);
  EXPECT_DOUBLE_EQ(estimate.mean, 3.0);
  EXPECT_NEAR(estimate.deviation, std::sqrt(2.5), 1e-12);
  EXPECT_NEAR(estimate.high - estimate.mean, 2.776 * std::sqrt(0.5), 1e-3);
  EXPECT_FALSE(estimate_mean(std::vector<double>{1.0}).has_interval());
  EXPECT_EQ(estimate_mean({}).count, 0u);
  const Estimate same = estimate_mean(std::vector<double>{2, 2, 2});
  EXPECT_TRUE(same.has_interval());
  EXPECT_DOUBLE_EQ(same.low, same.high);
}

TEST(EstimateOverStrata, LeavesOutHowStrataDiffer) {
  // two maps, far apart, each with the same small spread
  const std::vector<std::vector<double>> strata{{0, 1, 2}, {100, 101, 102}};
  const Estimate estimate = estimate_over_strata(strata);
  EXPECT_DOUBLE_EQ(estimate.mean, 51.0);
  // variance of the mean: (1/3 + 1/3) / 4, four degrees of freedom
  EXPECT_NEAR(estimate.high - estimate.mean, 2.776 * std::sqrt(1.0 / 6.0), 1e-3);
  const std::vector<std::vector<double>> one{{1, 2, 3}};
  EXPECT_DOUBLE_EQ(estimate_over_strata(one).low, estimate_mean(one[0]).low);
  const std::vector<std::vector<double>> single{{1, 2, 3}, {4}};
  EXPECT_FALSE(estimate_over_strata(single).has_interval());
}

}  // namespace
}  // namespace sumogamma
