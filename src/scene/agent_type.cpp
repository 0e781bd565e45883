#include "scene/agent_type.h"

#include <algorithm>

#include "base/error.h"
#include "base/units.h"

namespace sumogamma {

// NOLINTNEXTLINE(readability-function-size): a table
AgentTypeTable default_agent_types() {
  AgentTypeTable types;
  auto add = [&](AgentType type) { types.push_back(std::move(type)); };
  // sizes: SUMO's vClass defaults (page Vehicle_Type_Parameter_Defaults); wheelbases, horizons,
  // attention and responsibility: facts on the reference's AgentParams; accelerations: SUMO's
  // vClass defaults; in bends: the side friction that low-speed streets are designed for, 0.40 at
  // 20 km/h and 0.32 at 30 (docs/rules/paths.md), less where people stand or loads tip
  add({.name = "pedestrian",
       .sumo_class = "pedestrian",
       .kinematics = Kinematics::Holonomic,
       .length = 0.40,
       .width = 0.48,
       .wheelbase = 0.2,
       .rear_axle_to_center = 0.0,
       .max_steering = radians(90),
       .max_steering_rate = radians(360),
       .max_speed = 3.0,
       .preferred_speed = 1.3,
       .max_acceleration = 2.0,
       .comfortable_deceleration = 2.0,
       .max_deceleration = 5.0,
       .max_lateral_acceleration = 2.0,
       .tracking_error = 0.1,
       .horizon = 3.0,
       .attention_front = 8.0,
       .attention_rear = 2.0,
       .headway = 0.5,
       .min_gap = 0.25});
  add({.name = "bicycle",
       .sumo_class = "bicycle",
       .length = 1.65,
       .width = 0.65,
       .wheelbase = 1.05,
       .rear_axle_to_center = 0.5,
       .max_steering = radians(45),
       .max_steering_rate = radians(120),
       .max_speed = 8.0,
       .preferred_speed = 4.2,
       .max_acceleration = 1.2,
       .comfortable_deceleration = 2.0,
       .max_deceleration = 6.0,
       .max_lateral_acceleration = 2.0,
       .tracking_error = 0.3,
       .horizon = 4.0,
       .attention_front = 12.0,
       .attention_rear = 3.0,
       .headway = 1.0,
       .min_gap = 0.5});
  add({.name = "motorcycle",
       .sumo_class = "motorcycle",
       .length = 2.2,
       .width = 0.9,
       .wheelbase = 1.4,
       .rear_axle_to_center = 0.65,
       .max_steering = radians(40),
       .max_steering_rate = radians(90),
       .max_speed = 50.0,
       .preferred_speed = 13.9,
       .max_acceleration = 4.0,
       .comfortable_deceleration = 3.0,
       .max_deceleration = 8.0,
       .max_lateral_acceleration = 3.5,
       .tracking_error = 0.4,
       .horizon = 4.0,
       .attention_front = 15.0,
       .attention_rear = 4.0,
       .headway = 1.0,
       .min_gap = 1.0});
  add({.name = "car",
       .sumo_class = "passenger",
       .length = 4.5,
       .width = 1.8,
       .wheelbase = 2.7,
       .rear_axle_to_center = 1.3,
       .max_steering = radians(38),
       .max_steering_rate = radians(60),
       .max_speed = 55.0,
       .preferred_speed = 13.9,
       .max_acceleration = 2.5,
       .comfortable_deceleration = 2.5,
       .max_deceleration = 8.0,
       .max_lateral_acceleration = 3.5,
       .tracking_error = 0.5,
       .horizon = 4.0,
       .attention_front = 15.0,
       .attention_rear = 5.0,
       .headway = 1.35,
       .min_gap = 1.8});
  add({.name = "van",
       .sumo_class = "delivery",
       .length = 6.0,
       .width = 2.0,
       .wheelbase = 3.5,
       .rear_axle_to_center = 1.7,
       .max_steering = radians(38),
       .max_steering_rate = radians(55),
       .max_speed = 50.0,
       .preferred_speed = 13.9,
       .max_acceleration = 2.3,
       .comfortable_deceleration = 2.5,
       .max_deceleration = 8.0,
       .max_lateral_acceleration = 3.1,
       .tracking_error = 0.5,
       .horizon = 4.0,
       .attention_front = 15.0,
       .attention_rear = 5.0,
       .headway = 1.4,
       .min_gap = 1.8});
  add({.name = "bus",
       .sumo_class = "bus",
       .length = 12.0,
       .width = 2.5,
       .wheelbase = 6.0,
       .rear_axle_to_center = 2.7,
       .max_steering = radians(45),
       .max_steering_rate = radians(45),
       .max_speed = 25.0,
       .preferred_speed = 12.0,
       .max_acceleration = 1.2,
       .comfortable_deceleration = 1.8,
       .max_deceleration = 6.0,
       .max_lateral_acceleration = 1.8,
       .tracking_error = 0.6,
       .horizon = 5.0,
       .attention_front = 20.0,
       .attention_rear = 8.0,
       .headway = 1.55,
       .min_gap = 2.2});
  add({.name = "truck",
       .sumo_class = "truck",
       .length = 7.1,
       .width = 2.4,
       .wheelbase = 4.0,
       .rear_axle_to_center = 1.8,
       .max_steering = radians(42),
       .max_steering_rate = radians(45),
       .max_speed = 36.0,
       .preferred_speed = 12.0,
       .max_acceleration = 1.3,
       .comfortable_deceleration = 1.9,
       .max_deceleration = 6.0,
       .max_lateral_acceleration = 2.1,
       .tracking_error = 0.6,
       .horizon = 5.0,
       .attention_front = 20.0,
       .attention_rear = 8.0,
       .headway = 1.55,
       .min_gap = 2.2});
  add({.name = "electric_tricycle",
       .sumo_class = "moped",
       .length = 2.4,
       .width = 1.1,
       .wheelbase = 1.5,
       .rear_axle_to_center = 0.7,
       .max_steering = radians(45),
       .max_steering_rate = radians(90),
       .max_speed = 8.0,
       .preferred_speed = 5.0,
       .max_acceleration = 1.1,
       .comfortable_deceleration = 2.0,
       .max_deceleration = 6.0,
       .max_lateral_acceleration = 2.0,
       .tracking_error = 0.4,
       .horizon = 4.0,
       .attention_front = 12.0,
       .attention_rear = 3.0,
       .headway = 1.1,
       .min_gap = 0.8});
  add({.name = "gyro_scooter",
       .sumo_class = "moped",
       .length = 0.5,
       .width = 0.6,
       .wheelbase = 0.25,
       .rear_axle_to_center = 0.0,
       .max_steering = radians(60),
       .max_steering_rate = radians(180),
       .max_speed = 5.0,
       .preferred_speed = 2.5,
       .max_acceleration = 1.5,
       .comfortable_deceleration = 2.0,
       .max_deceleration = 5.0,
       .max_lateral_acceleration = 2.0,
       .tracking_error = 0.1,
       .horizon = 3.0,
       .attention_front = 8.0,
       .attention_rear = 2.0,
       .headway = 0.9,
       .min_gap = 0.4});
  // front loaders are 2.5 to 2.6 m long (Riese + Mueller Load: Bike, 28 June 2016; Urban Arrow
  // Family: 8.5 ft); width, wheelbase and lock are assumed, the rest is a bicycle's, slower with a
  // load
  add({.name = "cargo_bicycle",
       .sumo_class = "bicycle",
       .length = 2.5,
       .width = 0.85,
       .wheelbase = 1.9,
       .rear_axle_to_center = 0.9,
       .max_steering = radians(45),
       .max_steering_rate = radians(90),
       .max_speed = 7.0,
       .preferred_speed = 4.2,
       .max_acceleration = 0.8,
       .comfortable_deceleration = 2.0,
       .max_deceleration = 5.0,
       .max_lateral_acceleration = 1.8,
       .tracking_error = 0.4,
       .horizon = 4.0,
       .attention_front = 12.0,
       .attention_rear = 3.0,
       .headway = 1.0,
       .min_gap = 0.5});
  // on rails and on water: SUMO moves them, the others have to know their size and how they brake
  // (rail vehicles: SUMO's vClass defaults; service brakes)
  const AgentType rail{.name = "tram",
                       .sumo_class = "tram",
                       .length = 22.0,
                       .width = 2.4,
                       .wheelbase = 11.0,
                       .rear_axle_to_center = 5.5,
                       .max_steering = radians(30),
                       .max_steering_rate = radians(30),
                       .max_speed = 22.0,
                       .preferred_speed = 12.0,
                       .max_acceleration = 1.0,
                       .comfortable_deceleration = 1.2,
                       .max_deceleration = 3.0,
                       .max_lateral_acceleration = 1.0,
                       .tracking_error = 0.6,
                       .horizon = 5.0,
                       .attention_front = 20.0,
                       .attention_rear = 8.0,
                       .headway = 1.8,
                       .min_gap = 2.5,
                       .guided = true};
  add(rail);
  AgentType train = rail;
  train.name = "train";
  train.sumo_class = "rail";
  train.length = 135.0;
  train.width = 2.84;
  train.max_speed = 61.0;
  add(train);
  AgentType ship = rail;
  ship.name = "ship";
  ship.sumo_class = "ship";
  ship.length = 17.0;
  ship.width = 4.0;
  ship.max_speed = 10.0;
  ship.preferred_speed = 8.0;
  add(ship);
  return types;
}

AgentTypeId find_agent_type(const AgentTypeTable& types, std::string_view name) {
  const auto row =
      std::find_if(types.begin(), types.end(), [&](const AgentType& t) { return t.name == name; });
  if (row != types.end()) return static_cast<AgentTypeId>(row - types.begin());
  std::string known;
  for (const AgentType& type : types) known += (known.empty() ? "" : ", ") + type.name;
  throw Error("agent type '" + std::string(name) + "'", "no such type, expected one of " + known);
}

}  // namespace sumogamma
