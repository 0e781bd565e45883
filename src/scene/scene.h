#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/hash.h"
#include "geometry/heading.h"
#include "scene/agent_type.h"
#include "scene/behavior.h"
#include "scene/footprint.h"
#include "scene/road_context.h"

namespace sumogamma {

/// Stable for a run; SUMO's strings stay in src/sumo.
struct AgentId {
  std::uint32_t value = 0;
  friend auto operator<=>(const AgentId&,
                          const AgentId&) = default;  // NOLINT(modernize-use-nullptr): 14's own bug
};

/// Where an agent is on the lane network.
struct LanePosition {
  LaneId lane = kNoLane;
  double along = 0;   ///< of the footprint's centre [m] from the lane's start
  double offset = 0;  ///< [m], positive to the left
};

/// Who moves an agent. Others see every agent, whoever drives it.
enum class Control : std::uint8_t {
  Gamma,     ///< by this model
  External,  ///< by the world (SUMO): observed, never commanded
  Parked,    ///< by nobody: it stands off the road, in a place of the world's
  Planned,   ///< by a planner's wish, which its body follows: the ego of a drive
};

/// Does the world show an agent where we have moved it, instead of moving it?
inline bool is_ours(Control control) {
  return control == Control::Gamma || control == Control::Planned;
}

/// Which of its path's planned halts an agent comes to next, or stands at.
struct PlannedHalt {
  std::int32_t next = 0;  ///< index into Path::stops
  double left = 0;        ///< still to stand at the present one [s], 0 where there is none
};

/// For how long an agent has been held up.
struct Held {
  double standing = 0;    ///< since it was last faster than 0.3 m/s [s]
  double blocked = 0;     ///< for which it has stood although no rule holds it [s]
  double wedge_left = 0;  ///< for which it still drives as one that was stuck between bodies [s]
};

/// The state of everybody at one instant: parallel arrays of equal length, one entry an agent, in
/// order of id. A copyable value, so that a planner can fork it.
struct Scene {
  double time = 0;  ///< [s]
  std::int64_t tick = 0;
  std::vector<AgentId> id;
  std::vector<AgentTypeId> type;
  std::vector<Footprint> footprint;     ///< body axes about the centre [m]
  std::vector<Vec2> position;           ///< footprint centre [m]
  std::vector<Heading> heading;         ///< counter-clockwise from +x [rad]
  std::vector<Vec2> velocity;           ///< of the footprint centre [m/s]
  std::vector<double> speed;            ///< along the heading, of the rear axle; >= 0 [m/s]
  std::vector<double> steering;         ///< front wheel angle, positive left [rad]
  std::vector<Vec2> acceleration;       ///< observed, for KeepAcceleration [m/s^2]
  std::vector<double> preferred_speed;  ///< [m/s]
  std::vector<BehaviorState> behavior;
  std::vector<Manners> manners;  ///< drawn when the agent came
  std::vector<Control> control;
  std::vector<PathId> path;        ///< kNoPath off any network
  std::vector<double> path_along;  ///< of the centre along the path [m]
  std::vector<PlannedHalt> halt;
  std::vector<Held> held;
  std::vector<LanePosition> lane;
  std::vector<double> height;        ///< of the ground under the agent [m]: bridges
  std::vector<RoadContext> context;  ///< filled every tick from the frozen scene

  std::size_t size() const { return id.size(); }
};

/// One agent as a row to append. Everything that has a natural default has it.
struct AgentState {
  AgentId id;
  AgentTypeId type{};
  Footprint footprint;
  Vec2 position = Vec2::Zero();
  double heading = 0;
  double speed = 0;
  double preferred_speed = 0;
  BehaviorState behavior;
  Manners manners;
  Control control = Control::Gamma;
  PathId path = kNoPath;
};

/// Appends a row. Precondition: its id is larger than every id present (rows stay in order of id).
void append_agent(Scene& scene, const AgentState& agent);

/// Removes the rows marked true, keeping the order of the rest. `removed` has one entry a row.
void remove_agents(Scene& scene, const std::vector<bool>& removed);

/// Row of an id, or size() where it is not present. O(log n).
std::size_t find_row(const Scene& scene, AgentId id);

/// Likewise of an id as RoadContext::foe holds it, where -1 is nobody.
std::size_t find_foe(const Scene& scene, std::int64_t id);

/// Row of the agent that a row waits for on a road (RoadContext::foe), or size() where there is
/// none.
std::size_t foe_row(const Scene& scene, std::size_t row);

/// 64-bit FNV-1a hash continued from `hash` over every agent's id and exact state bits.
std::uint64_t hash_state(const Scene& scene, std::uint64_t hash = kFnvBasis);

}  // namespace sumogamma
