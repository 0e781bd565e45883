#include "sumo/control_choice.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sumogamma {
namespace {

TEST(ControlPattern, StarsAndQuestionMarks) {
  EXPECT_TRUE(matches("bus", "bus"));
  EXPECT_FALSE(matches("bus", "bus.1"));
  EXPECT_TRUE(matches("bus*", "bus.1"));
  EXPECT_TRUE(matches("*.1?", "flow.12"));
  EXPECT_FALSE(matches("*.1?", "flow.1"));
  EXPECT_TRUE(matches("a*b*c", "axxbyybzc"));
  EXPECT_FALSE(matches("a*b*c", "axxbyybz"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_FALSE(matches("", "x"));
}

TEST(ControlRule, ConcernsTypesVTypesAndIds) {
  ControlRule rule;
  EXPECT_TRUE(concerns(rule, "car", "passenger1", "veh0", 1)) << "everybody";
  rule.who = {"bicycle", "special*", "veh7"};
  EXPECT_TRUE(concerns(rule, "bicycle", "b", "x", 1));
  EXPECT_TRUE(concerns(rule, "car", "special_car", "x", 1));
  EXPECT_TRUE(concerns(rule, "car", "c", "veh7", 1));
  EXPECT_FALSE(concerns(rule, "car", "c", "veh8", 1));
}

TEST(ControlRule, AShareIsDrawnBySeedAndId) {
  ControlRule rule;
  rule.share = 0.3;
  int first = 0, both = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string id = "veh" + std::to_string(i);
    const bool one = concerns(rule, "car", "c", id, 1), other = concerns(rule, "car", "c", id, 2);
    EXPECT_EQ(one, concerns(rule, "car", "c", id, 1));
    first += one;
    both += one && other;
  }
  EXPECT_NEAR(first / 4000.0, 0.3, 0.03);
  EXPECT_NEAR(both / 4000.0, 0.09, 0.02) << "another seed draws others";
}

TEST(ControlRule, HoldsInAPlaceAndATime) {
  const Vec2 nowhere = Vec2::Constant(std::nan(""));
  ControlRule rule;
  rule.areas = {ring_of({0, 0, 10, 20})};
  rule.from = 5.0;
  rule.to = 8.0;
  EXPECT_TRUE(rule.changes());
  EXPECT_TRUE(holds(rule, Vec2(5, 5), nowhere, 5.0, 0.0));
  EXPECT_FALSE(holds(rule, Vec2(5, 5), nowhere, 8.0, 0.0));
  EXPECT_FALSE(holds(rule, Vec2(11, 5), nowhere, 6.0, 0.0));
  EXPECT_TRUE(holds(rule, Vec2(11, 5), nowhere, 6.0, 2.0)) << "who is in stays in a little longer";
  // a ring that isn't convex
  rule.areas = {ring_of({0, 0, 10, 0, 10, 10, 5, 2, 0, 10})};
  EXPECT_FALSE(holds(rule, Vec2(5, 8), nowhere, 6.0, 0.0));
  EXPECT_TRUE(holds(rule, Vec2(5, 1), nowhere, 6.0, 0.0));
}

TEST(ControlRule, ACircleWithoutItsAgentHoldsNobody) {
  ControlRule rule;
  rule.around = "bus.1";
  rule.radius = 50.0;
  EXPECT_TRUE(holds(rule, Vec2(30, 0), Vec2(0, 0), 0.0, 0.0));
  EXPECT_FALSE(holds(rule, Vec2(60, 0), Vec2(0, 0), 0.0, 0.0));
  EXPECT_FALSE(holds(rule, Vec2(30, 0), Vec2::Constant(std::nan("")), 0.0, 0.0));
}

TEST(ControlChoice, KnowsWhatItAsksFor) {
  EXPECT_TRUE(control_of_all().all());
  EXPECT_FALSE(control_of_all().changes());
  EXPECT_FALSE(ControlChoice{}.any());
  ControlRule rule;
  rule.who = {"car"};
  rule.around = "bus.1";
  rule.radius = 1.0;
  const ControlChoice choice{{rule}};
  EXPECT_FALSE(choice.all());
  EXPECT_TRUE(choice.changes());
  EXPECT_EQ(choice.names(), (std::set<std::string>{"bus.1", "car"}));
}

TEST(RingOf, BoxesAndRings) {
  EXPECT_EQ(ring_of({0, 0, 1, 1}).size(), 4u);
  EXPECT_EQ(ring_of({0, 0, 1, 1, 2, 0}).size(), 3u);
  EXPECT_TRUE(ring_of({0, 0, 1}).empty());
  EXPECT_TRUE(ring_of({0, 0}).empty());
}

}  // namespace
}  // namespace sumogamma
