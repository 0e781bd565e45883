#include "validation/verdict.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace sumogamma {
namespace {

Trial trial() {
  return {"T1",
          "Does <it> hold?",
          "A case.",
          "",
          {{"flow", "vehicles/h", {1700, 2000}, "a book", false, ""}},
          {}};
}

Judgement verdict_of(const Trial& trial, std::vector<double> values) {
  return judge(trial, trial.criteria.front(), std::move(values), {}).verdict;
}

TEST(Verdict, IsOfTheMeanOverSeeds) {
  const Trial case_ = trial();
  EXPECT_EQ(verdict_of(case_, {1600, 1900}), Judgement::Pass);
  EXPECT_EQ(verdict_of(case_, {1600, 1700}), Judgement::Fail);
  EXPECT_EQ(verdict_of(case_, {2000, 2000}), Judgement::Pass) << "the band's ends belong to it";
  EXPECT_EQ(verdict_of(case_, {2000, 2001}), Judgement::Fail);
}

TEST(Verdict, OutsideABandThatIsEmpiricalOnlyIsANote) {
  Trial case_ = trial();
  case_.criteria.front().empirical = true;
  EXPECT_EQ(verdict_of(case_, {1500, 1500}), Judgement::Note);
}

TEST(Verdict, ASeedWithNothingToMeasureFails) {
  Trial case_ = trial();
  case_.criteria.front().empirical = true;
  EXPECT_EQ(verdict_of(case_, {1800, std::nan("")}), Judgement::Fail);
  EXPECT_EQ(verdict_of(case_, {}), Judgement::Fail);
}

TEST(Verdict, BandsAreTold) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  EXPECT_EQ(band_text({1700, 2000}), "1700 to 2000");
  EXPECT_EQ(band_text({-kAny, 0.05}), "at most 0.05");
  EXPECT_EQ(band_text({3, kAny}), "at least 3");
  EXPECT_EQ(band_text({1, 1}), "1");
}

TEST(Verdict, TheFilesSayWhatCameOfEach) {
  const Trial case_ = trial();
  const std::vector<Outcome> outcomes{
      judge(case_, case_.criteria.front(), {1600, 1700}, {2300, 2400})};
  const nlohmann::json row = nlohmann::json::parse(outcomes_json(outcomes, "1"))["outcomes"][0];
  EXPECT_EQ(row["id"], "T1");
  EXPECT_EQ(row["mean"], 1650.0);
  EXPECT_EQ(row["sumo_mean"], 2350.0);
  EXPECT_EQ(row["band"], nlohmann::json({1700.0, 2000.0}));
  EXPECT_EQ(row["verdict"], "FAIL");
  EXPECT_LT(row["interval"][0], 1650.0);
  const std::string page = outcomes_html(outcomes, "1");
  EXPECT_NE(page.find("What fails"), std::string::npos);
  EXPECT_NE(page.find("Does &lt;it&gt; hold?"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_NE(outcomes_markdown(outcomes).find("| FAIL |"), std::string::npos);
}

}  // namespace
}  // namespace sumogamma
