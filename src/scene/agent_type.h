#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/compliance.h"

namespace sumogamma {

enum class AgentTypeId : std::uint16_t {};

/// How a body follows a velocity (f_A of Eq. 1).
enum class Kinematics : std::uint8_t {
  Holonomic,    ///< any direction at once: pedestrians
  SingleTrack,  ///< rolls about the rear axle, steers in front: everything on wheels
};

/// One row of the type table: all that is the same for every agent of a kind. SI units.
struct AgentType {
  std::string name;        ///< as in results and scenario.toml: "car"
  std::string sumo_class;  ///< SUMO vClass: "passenger"
  Kinematics kinematics = Kinematics::SingleTrack;
  double length = 0,
         width = 0;      ///< default footprint [m]; SUMO's vType wins where it says otherwise
  double wheelbase = 0;  ///< [m]
  double rear_axle_to_center =
      0;                         ///< [m], the rear axle lies this far behind the footprint's centre
  double max_steering = 0;       ///< [rad]
  double max_steering_rate = 0;  ///< [rad/s]
  double max_speed = 0;          ///< [m/s]
  double preferred_speed = 0;    ///< [m/s] where no road limits it
  double max_acceleration = 0;   ///< [m/s^2]
  double comfortable_deceleration = 0;             ///< [m/s^2]
  double max_deceleration = 0;                     ///< [m/s^2], emergency
  double max_lateral_acceleration = 0;             ///< comfort limit in bends [m/s^2]
  double tracking_error = 0;                       ///< epsilon_max of Eq. 1 [m]
  double horizon = 0;                              ///< tau [s]
  double attention_front = 0, attention_rear = 0;  ///< least reach of Att [m]; speed adds to it
  double headway = 0;                              ///< desired time gap to a leader [s]
  bool steady_headway = false;                     ///< at every speed and in all traffic
  double queue_headway = 0.32;                     ///< share of the headway kept where it stands
  double full_headway_speed = 11.0;                ///< from which on all of it is kept [m/s]
  double min_gap = 0;                              ///< standstill gap to a leader [m]
  double critical_gap = 1.0;     ///< left before whoever has the right of way in a place where ways
                                 ///< cross [s]: HCM's critical headway less the time of crossing
  bool guided = false;           ///< on rails or on water: SUMO alone moves it
  Compliance compliance{};       ///< how far it keeps the rules, and how its agents differ
  std::int32_t variant_of = -1;  ///< row that it counts as and whose name it has; -1: itself
};

/// Rows in a fixed order; index with AgentTypeId.
using AgentTypeTable = std::vector<AgentType>;

/// The built-in types (docs/scenario.md names them), those that SUMO alone moves last. Sizes and
/// limits after AgentParams of the reference and SUMO's vClass defaults; sources stand beside the
/// rows.
AgentTypeTable default_agent_types();

/// Vehicles below this width share lanes and filter between queues [m].
inline constexpr double kNarrowWidth = 1.2;

/// Does a body of this width share lanes?
inline bool is_narrow(double width) { return width < kNarrowWidth; }

/// Row named `name`, or -1 cast to the id type's count: throws Error listing the known names.
AgentTypeId find_agent_type(const AgentTypeTable& types, std::string_view name);

/// Row that an agent of this type counts as: rows that a vType of SUMO gave other values come and
/// go with scenarios.
inline AgentTypeId kind_of(const AgentTypeTable& types, AgentTypeId id) {
  const std::int32_t of = types[static_cast<std::size_t>(id)].variant_of;
  return of < 0 ? id : static_cast<AgentTypeId>(of);
}

inline const AgentType& type_of(const AgentTypeTable& types, AgentTypeId id) {
  return types[static_cast<std::size_t>(id)];
}

}  // namespace sumogamma
