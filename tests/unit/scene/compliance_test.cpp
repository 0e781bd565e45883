#include "scene/compliance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/behavior_preset.h"

namespace sumogamma {
namespace {

constexpr std::uint32_t kAgents = 20000;

/// Share of agents for which a draw holds at a place.
template <typename Holds>
double share(const Compliance& compliance, std::uint64_t seed, std::uint64_t place, Holds holds) {
  int count = 0;
  for (std::uint32_t id = 0; id < kAgents; ++id)
    count += holds(compliance, draw_manners(compliance, seed, id), place) ? 1 : 0;
  return static_cast<double>(count) / kAgents;
}

/// Four standard deviations of a binomial share.
double tolerance(double rate) { return 4.0 * std::sqrt(rate * (1.0 - rate) / kAgents); }

TEST(Compliance, RatesAreTheSharesAskedFor) {
  for (const double rate : {0.007, 0.26, 0.345, 0.9}) {
    Compliance compliance;
    compliance.red_light_running = compliance.jaywalking_rate = compliance.yielding_rate = rate;
    compliance.rolling_stops = compliance.creeping = rate;
    for (const std::uint64_t seed : {1u, 2u})
      for (const std::uint64_t place : {0u, 17u}) {
        EXPECT_NEAR(share(compliance, seed, place, runs_red_light), rate, tolerance(rate));
        EXPECT_NEAR(share(compliance, seed, place, jaywalks), rate, tolerance(rate));
        EXPECT_NEAR(share(compliance, seed, place, yields_to_people), rate, tolerance(rate));
        EXPECT_NEAR(share(compliance, seed, place, rolls_at_stop_sign), rate, tolerance(rate));
        EXPECT_NEAR(share(compliance, seed, place, creeps_at_red), rate, tolerance(rate));
      }
  }
}

TEST(Compliance, CompliantKeepsEveryRuleAndOneBreaksAll) {
  const Compliance compliant;
  EXPECT_EQ(share(compliant, 1, 3, runs_red_light), 0.0);
  EXPECT_EQ(share(compliant, 1, 3, jaywalks), 0.0);
  EXPECT_EQ(share(compliant, 1, 3, yields_to_people), 1.0);
  EXPECT_EQ(share(compliant, 1, 3, creeps_at_red), 0.0);
  Compliance lawless;
  lawless.red_light_running = lawless.jaywalking_rate = 1.0;
  lawless.yielding_rate = 0.0;
  EXPECT_EQ(share(lawless, 1, 3, runs_red_light), 1.0);
  EXPECT_EQ(share(lawless, 1, 3, jaywalks), 1.0);
  EXPECT_EQ(share(lawless, 1, 3, yields_to_people), 0.0);
  // nobody drew for who is driven by SUMO: it keeps the rules
  EXPECT_FALSE(runs_red_light(lawless, Manners{}, 3));
  EXPECT_FALSE(jaywalks(lawless, Manners{}, 3));
  EXPECT_TRUE(yields_to_people(lawless, Manners{}, 3));
}

TEST(Compliance, PlacesAndPurposesAreDrawnApart) {
  Compliance compliance;
  compliance.red_light_running = compliance.jaywalking_rate = 0.5;
  int same_place = 0, same_purpose = 0;
  for (std::uint32_t id = 0; id < kAgents; ++id) {
    const Manners manners = draw_manners(compliance, 1, id);
    const bool here = runs_red_light(compliance, manners, 1);
    EXPECT_EQ(here, runs_red_light(compliance, draw_manners(compliance, 1, id), 1));
    same_place += here == runs_red_light(compliance, manners, 2) ? 1 : 0;
    same_purpose += here == jaywalks(compliance, manners, 1) ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(same_place) / kAgents, 0.5, tolerance(0.5));
  EXPECT_NEAR(static_cast<double>(same_purpose) / kAgents, 0.5, tolerance(0.5));
}

TEST(Compliance, HeadwayAndSpeedFactorsSpreadAsAskedFor) {
  Compliance compliance;
  EXPECT_EQ(draw_manners(compliance, 1, 5).headway_factor, 1.0);
  compliance.headway_deviation = 0.2;
  compliance.speed_factor = 0.9;
  compliance.speed_factor_deviation = 0.1;
  double headway = 0, speed = 0, square = 0;
  for (std::uint32_t id = 0; id < kAgents; ++id) {
    const double factor = draw_manners(compliance, 1, id).headway_factor;
    EXPECT_GE(factor, 0.6 - 1e-12);
    EXPECT_LE(factor, 1.4 + 1e-12);
    headway += factor / kAgents;
    const double fast = draw_speed_factor(compliance, 1, id);
    speed += fast / kAgents;
    square += fast * fast / kAgents;
  }
  EXPECT_NEAR(headway, 1.0, 0.01);
  EXPECT_NEAR(speed, 0.9, 0.005);
  // cutting off at two deviations takes some of the spread
  EXPECT_NEAR(std::sqrt(square - speed * speed), 0.095, 0.005);
}

TEST(BehaviorPreset, CompliantIsTheDefaultAndObservedSaysWhatWasMeasured) {
  AgentTypeTable types = default_agent_types();
  apply_preset(BehaviorPreset::Observed, types);
  const auto& of = [&](const char* name) -> const AgentType& {
    return type_of(types, find_agent_type(types, name));
  };
  EXPECT_EQ(of("car").compliance.red_light_running, 0.011);
  EXPECT_EQ(of("motorcycle").compliance.red_light_running, 0.465);
  EXPECT_EQ(of("bicycle").compliance.red_light_running, 0.391);
  EXPECT_EQ(of("electric_tricycle").compliance.red_light_running, 0.273);
  EXPECT_GT(of("pedestrian").compliance.jaywalking_rate, 0.0);
  apply_preset(BehaviorPreset::Interaction, types);
  EXPECT_EQ(of("car").headway, 1.76);
  EXPECT_EQ(of("car").compliance.place_deviation, 0.58);
  EXPECT_EQ(of("motorcycle").compliance.place_deviation, 0.0);
  EXPECT_EQ(of("motorcycle").compliance.red_light_running, 0.0);
  const AgentTypeTable own = default_agent_types();
  EXPECT_EQ(of("bicycle").headway, type_of(own, find_agent_type(own, "bicycle")).headway);
  apply_preset(BehaviorPreset::Compliant, types);
  EXPECT_EQ(of("car").headway, type_of(own, find_agent_type(own, "car")).headway);
  EXPECT_EQ(of("car").min_gap, type_of(own, find_agent_type(own, "car")).min_gap);
  for (const AgentType& type : types) {
    EXPECT_EQ(type.compliance.red_light_running, 0.0) << type.name;
    EXPECT_EQ(type.compliance.jaywalking_rate, 0.0) << type.name;
    EXPECT_EQ(type.compliance.yielding_rate, 1.0) << type.name;
    EXPECT_EQ(type.critical_gap, 1.0) << type.name;
  }
}

}  // namespace
}  // namespace sumogamma
