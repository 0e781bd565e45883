#include "ego/ego_settings.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "ego/planners.h"

namespace sumogamma {
namespace {

std::string objection(const EgoSettings& settings, bool external = false) {
  try {
    check_settings(settings, 0.05, external);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(EgoSettings, TheDefaultsAreGood) { EXPECT_EQ(objection({}), ""); }

TEST(EgoSettings, ARateIsAtMostOneATick) {
  EgoSettings settings;
  settings.rate = 20;
  EXPECT_EQ(objection(settings), "");
  settings.rate = 20.5;
  EXPECT_NE(objection(settings).find("at most 20 a second"), std::string::npos);
  settings.rate = 0;
  EXPECT_NE(objection(settings), "");
}

TEST(EgoSettings, OneAccelerationBrakes) {
  EgoSettings settings;
  settings.accelerations = {0, 3};
  EXPECT_NE(objection(settings).find("has to brake"), std::string::npos);
}

TEST(EgoSettings, AnUnknownPlannerIsToldTheNearestOne) {
  EgoSettings settings;
  settings.planner = "gama";
  EXPECT_NE(objection(settings).find("'gamma'"), std::string::npos);
  EXPECT_EQ(objection(settings, true), "") << "one outside has none";
}

TEST(EgoSettings, AWindowIsABox) {
  EgoSettings settings;
  for (const std::vector<double>& window :
       std::vector<std::vector<double>>{{1}, {0, 0, 0, 5}, {5, 0, 0, 5}, {0, 0, 1, 1, 1}}) {
    settings.window = window;
    EXPECT_NE(objection(settings), "");
  }
  settings.window = {0, 0, 10, 10};
  EXPECT_EQ(objection(settings), "");
}

TEST(EgoSettings, AGoalIsNotWhereTheEgoStands) {
  EgoSettings settings;
  settings.goal_way = 1.5;
  EXPECT_NE(objection(settings), "");
}

TEST(Planners, HaveNamesOfTheirOwnAndTheReferenceFirst) {
  EXPECT_EQ(planners().front().name, "gamma");
  EXPECT_FALSE(make_planner("gamma"));
  for (std::size_t k = 1; k < planners().size(); ++k) {
    EXPECT_TRUE(make_planner(planners()[k].name));
    for (std::size_t other = 0; other < k; ++other)
      EXPECT_NE(planners()[k].name, planners()[other].name);
  }
}

}  // namespace
}  // namespace sumogamma
