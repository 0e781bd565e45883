#include "scene/behavior_preset.h"

#include <algorithm>

namespace sumogamma {

namespace {

/// What `observed` says of a type beyond `compliant`. Measured: red lights at the Tianjin junction
/// SinD 8_2_1, of those who go straight on or turn left (who turns right is exempt there): cars 2
/// of 181, motorcycles 59 of 127, bicycles 34 of 87, tricycles 6 of 22; walking speed and time
/// between people and vehicles in the DUT recordings; stop signs at an all-way stop of
/// INTERACTION's (MA: 0.83 of cars halt); creeping at Karlsruhe's junction k733 (1 of 24 cars at
/// red). The rest is assumed.
struct Observed {
  const char* type;
  double red_light_running, yielding_rate, jaywalking_rate, rolling_stops, creeping,
      headway_deviation, critical_gap;
};
constexpr double kRolling = 0.17, kCreeping = 0.042;
constexpr Observed kObserved[] = {
    {"pedestrian", 0.0, 1.0, 0.15, 0.0, 0.0, 0.0, 1.9},  // gap: DUT shared space, 5th percentile
    {"bicycle", 0.391, 0.5, 0.0, kRolling, kCreeping, 0.2, 1.0},            // red: SinD
    {"motorcycle", 0.465, 0.5, 0.0, kRolling, kCreeping, 0.2, 1.0},         // red: SinD
    {"car", 0.011, 0.7, 0.0, kRolling, kCreeping, 0.2, 1.0},                // red: SinD
    {"van", 0.011, 0.7, 0.0, kRolling, kCreeping, 0.2, 1.0},                // as cars
    {"bus", 0.011, 0.7, 0.0, kRolling, kCreeping, 0.2, 1.0},                // as cars
    {"truck", 0.011, 0.7, 0.0, kRolling, kCreeping, 0.2, 1.0},              // as cars
    {"electric_tricycle", 0.273, 0.5, 0.0, kRolling, kCreeping, 0.2, 1.0},  // red: SinD's tricycles
    {"gyro_scooter", 0.391, 0.5, 0.0, kRolling, kCreeping, 0.2, 1.0},       // as bicycles
};

/// Drivers of cars at four places of INTERACTION's (GL, MA, EP1, FT): the mean over places of what
/// was measured at each. Behind others at equal speed 1.63 to 1.97 s apart, by the median of each
/// driver, with a coefficient of variation of 0.34 to 0.50; standing 2.0 to 2.9 m apart (medians);
/// from 0 to 5 m/s with 1.3 to 1.6 m/s^2 on the mean, which a queue does here where it may have
/// 1.85 m/s^2 (`validate`, V2); beside the middle of their lanes by 0.47 to 0.73 m (deviation).
/// People go first in 0.68 of 209 meetings with cars (CQUT, two places).
void drive_as_at_interaction(AgentType& type) {
  constexpr double kHeadway = 1.76, kHeadwayDeviation = 0.4, kStandingGap = 2.4;
  constexpr double kAcceleration = 1.85, kPlaceDeviation = 0.58, kYielding = 0.68;
  type.headway = kHeadway;
  type.min_gap = kStandingGap;
  type.max_acceleration = std::min(type.max_acceleration, kAcceleration);
  type.compliance.headway_deviation = kHeadwayDeviation;
  type.compliance.place_deviation = kPlaceDeviation;
  type.compliance.yielding_rate = kYielding;
  type.compliance.rolling_stops = kRolling;
}

/// Speeds of the crowd of the paper's section V-B: about 4 m/s on four wheels, 2 on two, 1 on foot.
void make_unregulated(AgentType& type) {
  constexpr double kOnFoot = 1.0, kOnTwoWheels = 2.0, kDriving = 4.0, kSpread = 0.5;  // [m/s]
  type.compliance.free_speed = type.kinematics == Kinematics::Holonomic ? kOnFoot
                               : is_narrow(type.width)                  ? kOnTwoWheels
                                                                        : kDriving;
  type.compliance.free_speed_spread = kSpread;
}

}  // namespace

std::string_view name_of(BehaviorPreset preset) {
  switch (preset) {
    case BehaviorPreset::Observed:
      return "observed";
    case BehaviorPreset::Interaction:
      return "interaction";
    case BehaviorPreset::Unregulated:
      return "unregulated";
    case BehaviorPreset::Compliant:
      break;
  }
  return "compliant";
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  names.reserve(std::size(kBehaviorPresets));
  for (const BehaviorPreset preset : kBehaviorPresets) names.emplace_back(name_of(preset));
  return names;
}

void apply_preset(BehaviorPreset preset, AgentTypeTable& types) {
  const AgentTypeTable compliant = default_agent_types();
  for (AgentType& type : types) {
    const auto own = std::find_if(compliant.begin(), compliant.end(),
                                  [&](const AgentType& row) { return row.name == type.name; });
    if (own == compliant.end()) continue;
    type.compliance = own->compliance;
    type.critical_gap = own->critical_gap;
    type.headway = own->headway;
    type.min_gap = own->min_gap;
    type.max_acceleration = own->max_acceleration;
    // of who isn't wider nothing was measured
    if (preset == BehaviorPreset::Interaction && type.kinematics == Kinematics::SingleTrack &&
        !is_narrow(type.width))
      drive_as_at_interaction(type);
    if (preset == BehaviorPreset::Unregulated) make_unregulated(type);
    if (preset != BehaviorPreset::Observed) continue;
    for (const Observed& row : kObserved) {
      if (type.name != row.type) continue;
      type.compliance.red_light_running = row.red_light_running;
      type.compliance.yielding_rate = row.yielding_rate;
      type.compliance.jaywalking_rate = row.jaywalking_rate;
      type.compliance.rolling_stops = row.rolling_stops;
      type.compliance.creeping = row.creeping;
      type.compliance.headway_deviation = row.headway_deviation;
      type.critical_gap = row.critical_gap;
    }
    if (type.name == "pedestrian") {
      // 774 people on the DUT crosswalk: 1.22 +- 0.29 m/s, over SUMO's 1.39 m/s
      type.compliance.speed_factor = 0.88;
      type.compliance.speed_factor_deviation = 0.21;
    }
  }
}

}  // namespace sumogamma
