#include "sumo/sumo_agents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "scene/behavior_draw.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using ::testing::HasSubstr;

Model small_model() {
  Model model;
  model.types = default_agent_types();
  model.road = testing::small_net();
  return model;
}

std::string type_for(const std::string& type_id, const std::string& vehicle_class,
                     bool is_person = false) {
  const AgentTypeTable types = default_agent_types();
  SumoAgentDetails details;
  details.type_id = type_id;
  details.vehicle_class = vehicle_class;
  details.is_person = is_person;
  const auto type = agent_type_of(types, details);
  return type ? type_of(types, *type).name : "";
}

TEST(AgentTypeOf, TheTypesOwnNameWins) {
  EXPECT_EQ(type_for("electric_tricycle", "moped"), "electric_tricycle");
  EXPECT_EQ(type_for("bus", "passenger"), "bus");
}

TEST(AgentTypeOf, ElseTheVehicleClassDecides) {
  EXPECT_EQ(type_for("DEFAULT_VEHTYPE", "passenger"), "car");
  EXPECT_EQ(type_for("sedan", "taxi"), "car");
  EXPECT_EQ(type_for("x", "delivery"), "van");
  EXPECT_EQ(type_for("x", "coach"), "bus");
  EXPECT_EQ(type_for("x", "trailer"), "truck");
  EXPECT_EQ(type_for("x", "moped"), "motorcycle");
  EXPECT_EQ(type_for("x", "bicycle"), "bicycle");
  EXPECT_EQ(type_for("DEFAULT_PEDTYPE", "pedestrian", true), "pedestrian");
  EXPECT_EQ(type_for("x", "wheelchair", true), "pedestrian");
}

// their class says who may use a lane, not what comes
TEST(AgentTypeOf, TheBodyDecidesWhereTheClassDoesNot) {
  struct Body {
    double length, width;
    const char* type;
  };
  constexpr Body kBodies[] = {{4.5, 1.8, "car"},      {5.0, 1.8, "car"},  {6.5, 2.16, "van"},
                              {8.0, 2.4, "truck"},    {12.0, 2.5, "bus"}, {2.2, 0.9, "motorcycle"},
                              {1.6, 0.65, "bicycle"}, {0.0, 0.0, "car"}};
  const AgentTypeTable types = default_agent_types();
  for (const char* vehicle_class : {"private", "hov", "evehicle", "custom1", "custom2", "authority",
                                    "army", "vip", "emergency", "ignoring"})
    for (const Body& body : kBodies) {
      SumoAgentDetails details;
      details.type_id = "x";
      details.vehicle_class = vehicle_class;
      details.length = body.length;
      details.width = body.width;
      const auto type = agent_type_of(types, details);
      ASSERT_TRUE(type) << vehicle_class;
      EXPECT_EQ(type_of(types, *type).name, body.type) << vehicle_class << " " << body.length;
    }
}

TEST(AgentTypeOf, WhatRunsOnRailsOrWaterHasABodyThatSumoMoves) {
  const AgentTypeTable types = default_agent_types();
  for (const char* train : {"rail", "rail_urban", "rail_electric", "rail_fast"})
    EXPECT_EQ(type_for("x", train), "train") << train;
  for (const char* other : {"tram", "ship"}) EXPECT_EQ(type_for("x", other), other);
  for (const char* name : {"tram", "train", "ship"})
    EXPECT_TRUE(type_of(types, find_agent_type(types, name)).guided) << name;
}

TEST(PathOf, StartsAtTheCentreOfTheBody) {
  const Model model = small_model();
  SumoAgentDetails details;
  details.route = {"in", "out"};
  details.vehicle_class = "passenger";
  details.length = 4.5;
  details.lane = "in_1";
  details.lane_position = 20;  // of the front bumper
  details.speed_factor = 1;
  details.max_speed = 50;
  std::string why;
  const auto path = path_of(model, details, find_agent_type(model.types, "car"), why);
  ASSERT_NE(path, nullptr) << why;
  EXPECT_NEAR(path->line.point_at(0).x(), 17.75, 1e-9);
  EXPECT_NEAR(path->arrival, 200 - 17.75, 1e-9);
  EXPECT_FALSE(path->walking);
}

TEST(PathOf, CarriesPlannedHaltsInOrder) {
  const Model model = small_model();
  SumoAgentDetails details;
  details.route = {"in", "out"};
  details.vehicle_class = "bus";
  details.length = 12;
  details.lane = "in_1";
  details.lane_position = 12;
  const auto stop = [](const char* lane, double start, double end) {
    SumoAgentDetails::Stop one;
    one.lane = lane;
    one.start = start;
    one.end = end;
    return one;
  };
  details.stops = {stop("in_1", 50, 60), stop("nowhere_0", 1, 2), stop("out_0", 20, 40)};
  std::string why;
  const auto path = path_of(model, details, find_agent_type(model.types, "bus"), why);
  ASSERT_NE(path, nullptr) << why;
  ASSERT_EQ(path->stops.size(), 2u);
  EXPECT_NEAR(path->stops[0].along, 60 - 6, 0.6);
  // the world says when it is over
  EXPECT_TRUE(std::isinf(path->stops[0].duration));
  EXPECT_EQ(path->stops[0].plan, 0);
  EXPECT_EQ(path->stops[1].plan, 2);
  EXPECT_NEAR(path->stops[1].along, 105 + 40 - 6, 0.6);
}

TEST(PathOf, SaysWhyThereIsNone) {
  const Model model = small_model();
  SumoAgentDetails details;
  details.vehicle_class = "passenger";
  details.route = {"in", "moon"};
  std::string why;
  EXPECT_EQ(path_of(model, details, find_agent_type(model.types, "car"), why), nullptr);
  EXPECT_THAT(why, HasSubstr("edge 'moon' is not in the network"));
  details.route = {"in", "bridge"};
  EXPECT_EQ(path_of(model, details, find_agent_type(model.types, "car"), why), nullptr);
  EXPECT_THAT(why, HasSubstr("bridge"));
  details.is_person = true;
  details.route = {"out"};
  EXPECT_EQ(path_of(model, details, find_agent_type(model.types, "pedestrian"), why), nullptr);
  EXPECT_THAT(why, HasSubstr("pedestrians"));
}

TEST(DrawBehavior, IsAPureFunctionOfSeedAndId) {
  const AgentTypeTable types = default_agent_types();
  const AgentType& car = type_of(types, find_agent_type(types, "car"));
  std::set<double> seen;
  for (std::uint32_t id = 0; id < 200; ++id) {
    const BehaviorState drawn = draw_behavior(car, 7, id), again = draw_behavior(car, 7, id);
    EXPECT_EQ(drawn.responsibility, again.responsibility);
    EXPECT_EQ(drawn.attention.front, again.attention.front);
    EXPECT_EQ(drawn.intention.kind, IntentionKind::Path);
    EXPECT_GE(drawn.responsibility, 0.0);
    EXPECT_LE(drawn.responsibility, 1.0);
    EXPECT_GT(drawn.attention.front, 0.5 * car.attention_front);
    EXPECT_LT(drawn.attention.front, 2.0 * car.attention_front);
    EXPECT_NEAR(drawn.attention.front / drawn.attention.rear,
                car.attention_front / car.attention_rear, 1e-9);
    seen.insert(drawn.responsibility);
  }
  EXPECT_EQ(seen.size(), 200u);
  EXPECT_NE(draw_behavior(car, 7, 1).responsibility, draw_behavior(car, 8, 1).responsibility);
}

TEST(ChooseSpeedFactor, SumosStaysUnlessTheTypeHasOne) {
  AgentTypeTable types = default_agent_types();
  AgentType car = type_of(types, find_agent_type(types, "car"));
  SumoAgentDetails details;
  details.id = "car.7";
  details.speed_factor = 1.1;
  details.max_speed = 30;
  choose_speed_factor(car, 1, details);
  EXPECT_EQ(details.speed_factor, 1.1);
  car.compliance.speed_factor = 0.8;
  choose_speed_factor(car, 1, details);
  EXPECT_EQ(details.speed_factor, 0.8);  // not 0.88
  EXPECT_EQ(details.max_speed, 30);
  details.vehicle_class = "bicycle";  // at a pace of its own, which held SUMO's factor
  details.speed_factor = 1.2;
  details.max_speed = 4.8;
  choose_speed_factor(car, 1, details);
  EXPECT_NEAR(details.max_speed, 3.2, 1e-12);
  car.compliance.speed_factor_deviation = 0.1;
  choose_speed_factor(car, 1, details);
  const double first = details.speed_factor;
  choose_speed_factor(car, 1, details);
  EXPECT_EQ(details.speed_factor, first);
  choose_speed_factor(car, 2, details);
  EXPECT_NE(details.speed_factor, first);
}

/// Pace of somebody on a bicycle whom SUMO lets ride at `allowed` on the small net's road.
double pace_of(const std::string& vehicle_class, double allowed, double factor) {
  const Model model = small_model();
  SumoAgentDetails details;
  details.vehicle_class = vehicle_class;
  details.lane = "in_1";
  details.max_speed = 13.0;
  details.speed_factor = factor;
  details.allowed_speed = allowed;
  choose_pace(model.road, details);
  return details.max_speed;
}

TEST(ChoosePace, IsWhatSumoLetsABicycleRideWhereTheRoadAllowsMore) {
  const double limit =
      small_model().road.lane(small_model().road.lane_by_name.at("in_1")).speed_limit;
  ASSERT_GT(limit, 10.0);
  EXPECT_EQ(pace_of("bicycle", 3.8, 0.9), 3.8);
  // the road decides, or nothing is known: SUMO's default, 20 km/h
  EXPECT_DOUBLE_EQ(pace_of("bicycle", 0.9 * limit, 0.9), 5.0);
  EXPECT_DOUBLE_EQ(pace_of("bicycle", 0.0, 0.9), 5.0);
  EXPECT_EQ(pace_of("passenger", 3.8, 0.9), 13.0);
}

TEST(ChooseMidBlock, IsDrawnForPeopleAtTheRateOfTheirType) {
  AgentTypeTable types = default_agent_types();
  AgentType person = type_of(types, find_agent_type(types, "pedestrian"));
  SumoAgentDetails details;
  details.is_person = true;
  double crossing = 0, sum = 0;
  for (int k = 0; k < 2000; ++k) {
    details.id = "person." + std::to_string(k);
    person.compliance.jaywalking_rate = 0;
    choose_mid_block(person, 1, details);
    EXPECT_LT(details.mid_block, 0.0);
    person.compliance.jaywalking_rate = 0.3;
    choose_mid_block(person, 1, details);
    EXPECT_LT(details.mid_block, 1.0);
    if (details.mid_block < 0.0) continue;
    ++crossing;
    sum += details.mid_block;
  }
  EXPECT_NEAR(crossing / 2000, 0.3, 0.04);
  EXPECT_NEAR(sum / crossing, 0.5, 0.05);
  SumoAgentDetails car;
  person.compliance.jaywalking_rate = 1;
  choose_mid_block(person, 1, car);
  EXPECT_LT(car.mid_block, 0.0);
}

TEST(DrawPathOffset, TheSlowKeepToTheKerb) {
  Model model = small_model();
  for (const bool left_hand : {false, true}) {
    model.road.left_hand = left_hand;
    for (std::uint32_t id = 0; id < 100; ++id)
      for (const AgentType& type : model.types) {
        const double offset = draw_path_offset(model, type, 1, {id});
        EXPECT_LE(std::abs(offset), 1.0);
        if (type.width >= 1.2) continue;
        // positive is left, where the kerb is with left-hand traffic
        EXPECT_GT(left_hand ? offset : -offset, 0.0) << type.name;
      }
  }
}

TEST(DrawPathOffset, DriversSpreadOverTheirLanesAsTheirTypeSays) {
  Model model = small_model();
  AgentType car = type_of(model.types, find_agent_type(model.types, "car"));
  car.compliance.place_deviation = 0.58;
  double sum = 0, square = 0;
  constexpr int kDrivers = 4000;
  for (std::uint32_t id = 0; id < kDrivers; ++id) {
    const double offset = draw_path_offset(model, car, 1, {id});
    EXPECT_LE(std::abs(offset), 2 * 0.58);
    sum += offset / kDrivers;
    square += offset * offset / kDrivers;
  }
  EXPECT_NEAR(sum, 0.0, 0.03);
  // cutting off at two deviations takes some of the spread
  EXPECT_NEAR(std::sqrt(square), 0.55, 0.02);
}

}  // namespace
}  // namespace sumogamma
