#include "sumo/vehicle_types.h"

#include <gtest/gtest.h>

#include "model/kinematic_set.h"

namespace sumogamma {
namespace {

/// A passenger car of whose type nothing but the class is said, as SUMO tells it.
SumoAgentDetails plain_car() {
  SumoAgentDetails details;
  details.vehicle_class = "passenger";
  details.length = 5.0;
  details.width = 1.8;
  details.max_speed = 200.0 / 3.6;
  details.type = {2.6, 4.5, 9.0, 1.0, 2.5, 0.5};
  return details;
}

class VehicleTypes : public ::testing::Test {
 protected:
  VehicleTypes() {
    model_.types = default_agent_types();
    Workers workers(1);
    model_.kinematics = build_kinematic_tables(model_.types, workers);
    car_ = find_agent_type(model_.types, "car");
  }
  const AgentType& row(AgentTypeId id) const { return type_of(model_.types, id); }

  Model model_;
  AgentTypeId car_{};
};

TEST_F(VehicleTypes, WhoSaysNothingKeepsItsRow) {
  VehicleTypeRows rows(model_, {});
  const std::size_t before = model_.types.size();
  EXPECT_EQ(rows.row_of(car_, plain_car()), car_);
  EXPECT_EQ(model_.types.size(), before);
}

// import writes what the rows have: no other row may come of that
TEST_F(VehicleTypes, WhatAnImportSaysIsItsRow) {
  VehicleTypeRows rows(model_, {});
  for (std::size_t k = 0; k < 9; ++k) {
    const AgentType type = model_.types[k];
    SumoAgentDetails details;
    details.vehicle_class = type.sumo_class;
    details.length = type.length;
    details.width = type.width;
    details.max_speed = type.max_speed;
    details.type.min_gap = type.min_gap;
    EXPECT_EQ(rows.row_of(static_cast<AgentTypeId>(k), details), static_cast<AgentTypeId>(k))
        << type.name;
  }
}

TEST_F(VehicleTypes, TakesWhatIsSaidAndNothingElse) {
  VehicleTypeRows rows(model_, {});
  SumoAgentDetails details = plain_car();
  details.type.acceleration = 0.6;
  details.type.headway = 2.5;
  const AgentTypeId id = rows.row_of(car_, details);
  ASSERT_NE(id, car_);
  EXPECT_EQ(row(id).max_acceleration, 0.6);
  EXPECT_EQ(row(id).headway, 2.5);
  EXPECT_TRUE(row(id).steady_headway);
  EXPECT_EQ(row(id).comfortable_deceleration, row(car_).comfortable_deceleration);
  EXPECT_EQ(row(id).min_gap, row(car_).min_gap);
  EXPECT_EQ(row(id).wheelbase, row(car_).wheelbase);
  EXPECT_EQ(row(id).name, "car") << "counts as one";
  EXPECT_EQ(kind_of(model_.types, id), car_);
  EXPECT_EQ(model_.kinematics.size(), model_.types.size());
  EXPECT_EQ(rows.row_of(car_, details), id) << "one row for all of them";
  EXPECT_EQ(find_agent_type(model_.types, "car"), car_);
}

TEST_F(VehicleTypes, WhoDawdlesSpeedsUpLess) {
  VehicleTypeRows rows(model_, {});
  SumoAgentDetails details = plain_car();
  details.type.imperfection = 1.0;
  EXPECT_EQ(row(rows.row_of(car_, details)).max_acceleration, 0.5 * row(car_).max_acceleration);
  details.type.imperfection = 0.0;
  EXPECT_EQ(rows.row_of(car_, details), car_);
  details.type.imperfection = -1.0;
  EXPECT_EQ(rows.row_of(car_, details), car_) << "its model knows none";
}

TEST_F(VehicleTypes, NobodyBrakesHarderAtEaseThanInAnEmergency) {
  VehicleTypeRows rows(model_, {});
  SumoAgentDetails details = plain_car();
  details.type.deceleration = 9.5;
  EXPECT_EQ(row(rows.row_of(car_, details)).max_deceleration, 9.5);
  details.type.deceleration = 1.0;
  details.type.emergency_deceleration = 3.0;
  const AgentType& weak = row(rows.row_of(car_, details));
  EXPECT_EQ(weak.comfortable_deceleration, 1.0);
  EXPECT_EQ(weak.max_deceleration, 3.0);
}

TEST_F(VehicleTypes, ScenarioTomlWins) {
  VehicleTypeRows rows(model_, {"types.car.min_gap"});
  SumoAgentDetails details = plain_car();
  details.type.min_gap = 5.0;
  EXPECT_EQ(rows.row_of(car_, details), car_);
  details.type.acceleration = 1.0;
  EXPECT_EQ(row(rows.row_of(car_, details)).min_gap, row(car_).min_gap);
}

TEST_F(VehicleTypes, ALongBodyHasItsAxlesFarApart) {
  VehicleTypeRows rows(model_, {});
  const AgentTypeId truck = find_agent_type(model_.types, "truck");
  SumoAgentDetails trailer;
  trailer.vehicle_class = "trailer";
  trailer.length = 16.5;  // SUMO's default for these, not that of trucks
  trailer.width = 2.55;
  trailer.max_speed = 130.0 / 3.6;
  const AgentType& longer = row(rows.row_of(truck, trailer));
  EXPECT_GT(longer.wheelbase, 1.5 * row(truck).wheelbase);
  EXPECT_LE(longer.wheelbase, 7.0);
  EXPECT_NEAR(longer.rear_axle_to_center / longer.wheelbase,
              row(truck).rear_axle_to_center / row(truck).wheelbase, 1e-9);
  SumoAgentDetails short_car = plain_car();
  short_car.length = 2.5;
  EXPECT_NEAR(row(rows.row_of(car_, short_car)).wheelbase, 2.7 * 2.5 / 4.5, 1e-9);
}

// what SUMO lets drive faster than the row's body can
TEST_F(VehicleTypes, AFastBodyIsOne) {
  VehicleTypeRows rows(model_, {});
  const AgentTypeId bicycle = find_agent_type(model_.types, "bicycle");
  SumoAgentDetails details;
  details.vehicle_class = "bicycle";
  details.length = 1.6;
  details.width = 0.65;
  details.max_speed = 12.5;
  EXPECT_EQ(row(rows.row_of(bicycle, details)).max_speed, 12.5);
  details.max_speed = 5.0;
  EXPECT_EQ(rows.row_of(bicycle, details), bicycle) << "the agent's own pace holds it";
}

TEST_F(VehicleTypes, PeopleHaveTheirBody) {
  VehicleTypeRows rows(model_, {});
  const AgentTypeId walker = find_agent_type(model_.types, "pedestrian");
  SumoAgentDetails details;
  details.is_person = true;
  details.vehicle_class = "pedestrian";
  details.length = 0.215;
  details.width = 0.478;
  details.max_speed = 5.0 / 3.6;
  EXPECT_EQ(rows.row_of(walker, details), walker) << "SUMO's default";
  details.width = 0.9;
  EXPECT_EQ(row(rows.row_of(walker, details)).width, 0.9);
}

}  // namespace
}  // namespace sumogamma
