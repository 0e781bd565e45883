#include "sumo/vehicle_types.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "model/kinematic_set.h"

namespace sumogamma {

namespace {

/// What SUMO 1.15 gives a vType that says nothing but its class, as its getters tell it.
struct ClassDefaults {
  std::string_view name;
  double acceleration, deceleration, emergency_deceleration;  ///< [m/s^2]
  double min_gap, length, width;                              ///< [m]
  double max_speed;                                           ///< [m/s]
};

constexpr double kDefaultHeadway = 1.0;       // tau of every class [s]
constexpr double kDefaultImperfection = 0.5;  // sigma of every class on roads
constexpr ClassDefaults kPassenger{"passenger", 2.6, 4.5, 9.0, 2.5, 5.0, 1.8, 200.0 / 3.6};
constexpr ClassDefaults kDefaults[] = {
    {"pedestrian", 1.5, 2.0, 5.0, 0.25, 0.215, 0.478, 37.58 / 3.6},
    {"bicycle", 1.2, 3.0, 7.0, 0.5, 1.6, 0.65, 50.0 / 3.6},
    {"moped", 1.1, 7.0, 10.0, 2.5, 2.1, 0.78, 60.0 / 3.6},
    {"motorcycle", 6.0, 10.0, 10.0, 2.5, 2.2, 0.9, 200.0 / 3.6},
    {"delivery", 2.6, 4.5, 9.0, 2.5, 6.5, 2.16, 200.0 / 3.6},
    {"emergency", 2.6, 4.5, 9.0, 2.5, 6.5, 2.16, 200.0 / 3.6},
    {"bus", 1.2, 4.0, 7.0, 2.5, 12.0, 2.5, 100.0 / 3.6},
    {"coach", 2.0, 4.0, 7.0, 2.5, 14.0, 2.6, 100.0 / 3.6},
    {"truck", 1.3, 4.0, 7.0, 2.5, 7.1, 2.4, 130.0 / 3.6},
    {"trailer", 1.1, 4.0, 7.0, 2.5, 16.5, 2.55, 130.0 / 3.6},
};

const ClassDefaults& defaults_of(std::string_view vehicle_class) {
  const auto* row = std::find_if(std::begin(kDefaults), std::end(kDefaults),
                                 [&](const ClassDefaults& d) { return d.name == vehicle_class; });
  return row == std::end(kDefaults) ? kPassenger : *row;
}

bool differs(double told, double usual) { return std::abs(told - usual) > 1e-4; }

/// The body, where it is neither the row's nor what SUMO gives the row's class. The longest of real
/// ones bend to get round, as all have to turn within one circle (12.5 m in Europe): their axles
/// aren't as far apart as they are long.
void take_body(const SumoAgentDetails& details, AgentType& type) {
  constexpr double kLongestWheelbase = 7.0;  // [m]
  const ClassDefaults& usual = defaults_of(type.sumo_class);
  auto is_other = [](double told, double rows, double usually) {
    return told > 0.0 && differs(told, rows) && differs(told, usually);
  };
  if (is_other(details.width, type.width, usual.width)) type.width = details.width;
  if (!is_other(details.length, type.length, usual.length)) return;
  if (type.kinematics == Kinematics::SingleTrack) {
    const double most = std::max(kLongestWheelbase / type.wheelbase, 1.0);
    const double scale = std::min(details.length / type.length, most);
    type.wheelbase *= scale;
    type.rear_axle_to_center *= scale;
  }
  type.length = details.length;
}

}  // namespace

AgentType with_vehicle_type(const AgentType& row, const SumoAgentDetails& details,
                            const std::set<std::string>& kept) {
  constexpr double kLeastHeadway = 0.05;  // nobody can follow at nothing [s]
  const ClassDefaults& usual = defaults_of(details.vehicle_class);
  AgentType type = row;
  auto take = [&](double told, double usually, const char* key, double& field) {
    if (told < 0.0 || !differs(told, usually) || kept.contains("types." + row.name + "." + key))
      return false;
    field = told;
    return true;
  };
  const SumoVehicleType& said = details.type;
  take(said.acceleration, usual.acceleration, "max_acceleration", type.max_acceleration);
  // Krauss's driver loses half of sigma's share of its acceleration on average
  double imperfection = 0.0;
  if (take(said.imperfection, kDefaultImperfection, "max_acceleration", imperfection))
    type.max_acceleration *= 1.0 - 0.5 * std::min(imperfection, 1.0);
  take(said.deceleration, usual.deceleration, "comfortable_deceleration",
       type.comfortable_deceleration);
  take(said.emergency_deceleration, usual.emergency_deceleration, "max_deceleration",
       type.max_deceleration);
  type.max_deceleration = std::max(type.max_deceleration, type.comfortable_deceleration);
  take(said.min_gap, usual.min_gap, "min_gap", type.min_gap);
  if (take(said.headway, kDefaultHeadway, "headway", type.headway)) {
    type.headway = std::max(type.headway, kLeastHeadway);
    type.steady_headway = true;
  }
  // an agent's own speed is never above that of its vType: here only what the body can
  double fastest = type.max_speed;
  if (take(details.max_speed, usual.max_speed, "max_speed", fastest))
    type.max_speed = std::max(type.max_speed, fastest);
  take_body(details, type);
  return type;
}

VehicleTypeRows::Values VehicleTypeRows::values_of(const AgentType& type) {
  return {type.max_acceleration,
          type.comfortable_deceleration,
          type.max_deceleration,
          type.min_gap,
          type.headway,
          type.steady_headway ? 1.0 : 0.0,
          type.max_speed,
          type.length,
          type.width,
          type.wheelbase,
          type.rear_axle_to_center};
}

AgentTypeId VehicleTypeRows::row_of(AgentTypeId kind, const SumoAgentDetails& details) {
  const AgentType& row = type_of(model_.types, kind);
  AgentType type = with_vehicle_type(row, details, kept_);
  const Values values = values_of(type);
  if (values == values_of(row)) {
    KinematicTable& table = model_.kinematics[static_cast<std::size_t>(kind)];
    if (!table.is_built()) table = build_kinematic_tables({row}, workers_).front();
    return kind;
  }
  const auto [known, fresh] = rows_.try_emplace({kind, values}, kind);
  if (!fresh || model_.types.size() > std::numeric_limits<std::uint16_t>::max())
    return known->second;
  type.variant_of = static_cast<std::int32_t>(kind);
  model_.kinematics.push_back(build_kinematic_tables({type}, workers_).front());
  model_.types.push_back(std::move(type));
  return known->second = static_cast<AgentTypeId>(model_.types.size() - 1);
}

}  // namespace sumogamma
