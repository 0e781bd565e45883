#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/units.h"
#include "road/path.h"
#include "scene/scene.h"
#include "scene/trip.h"
#include "sumo/backend.h"

namespace sumogamma {

/// Whom SUMO means: is it a person, SUMO's id.
using SumoTraveller = std::pair<bool, std::string>;

/// SUMO's reference point of a footprint's centre, and back with a negative length: front bumper
/// for vehicles, centre for persons (length 0).
inline Vec2 reference_point(const Vec2& center, double heading, double length) {
  return center + 0.5 * length * direction_of(heading);
}

/// Departed in SUMO, and kept off the map until its place is free; or watched, and not in the scene
/// at present.
struct PendingAgent {
  SumoAgentDetails details;
  AgentTypeId type{};
  /// A way on which it may enter.
  struct Entry {
    std::shared_ptr<const Path> path;
    std::optional<AgentId> blocker;  ///< who was last in the way there
  };
  double depart_speed = std::numeric_limits<double>::infinity();  ///< starts no faster [m/s]
  Entry entry;                 ///< from the lane that SUMO chose; no path where there is none
  std::vector<Entry> besides;  ///< from the lanes beside it, once needed
  bool looked_besides = false;
  bool resumes = false;      ///< SUMO has it for a while: ours as soon as it moves on
  bool off_lane = false;     ///< SUMO has been told that it waits
  bool was_delayed = false;  ///< its insertion by SUMO was put off once
  double since = -1;         ///< when SUMO had inserted it [s]; negative: it was there before
  /// Parked: where SUMO shows its front, and its angle [deg]; others wait off the map.
  Vec2 waits_at = Vec2::Constant(std::nan(""));
  double waiting_angle = 0;
};

/// SUMO's own vehicle, which waits off the map for room among ghosts.
struct DelayedVehicle {
  PendingAgent pending;
  Vec2 front = Vec2::Zero();  ///< where SUMO had inserted it, its angle [deg], speed and lane
  double angle = 0, speed = 0;
  LaneId lane = kNoLane;
  bool off_lane = false;  ///< as PendingAgent::off_lane
};

/// What SUMO does with a vehicle of ours that halts at a stop of its plan.
enum class StopService {
  None,
  Asked,     ///< it is on its lane there, SUMO has not said yet that it stands
  Standing,  ///< SUMO counts its time, lets people in and out
};

/// How SUMO went on with a vehicle in the steps after it was handed back.
struct HandBack {
  double position = 0;      ///< most that it was off where its speed and heading led in a step [m]
  double heading = 0;       ///< largest change in a step [rad]
  double speed = 0;         ///< likewise [m/s]
  double acceleration = 0;  ///< largest [m/s^2]
};

/// What is watched of a vehicle that was handed back.
struct HandBackWatch {
  int steps = -1;                  ///< since then; negative: over, or never
  HandBack seen;                   ///< so far
  Vec2 last_front = Vec2::Zero();  ///< where SUMO had its front in the step before [m]
  double last_heading = 0;         ///< [rad]
  double last_speed = 0;           ///< [m/s]
};

/// What we keep SUMO's driver of a vehicle from.
struct DriverHold {
  bool speed = false;           ///< we hold its speed behind a ghost
  bool lane = false;            ///< we keep it from changing lanes beside a ghost
  bool overtaking = false;      ///< we keep it off the opposite lane
  std::string eagerness;        ///< its own for that, once asked for
  double keeps_lane_until = 0;  ///< no lane change so soon after it was ours [s]
};

/// What is known of an agent beyond the scene.
struct KnownAgent {
  std::string sumo_id;
  bool is_person = false;
  bool external = false;
  std::uint32_t rules = 0;  ///< that may concern it, as bits
  bool sumos_own = false;   ///< nobody but SUMO can move it
  bool leaves = false;      ///< ours, and wanted by no rule any more
  bool was_kept = false;    ///< counted in LifeCycle::kept_on_foot
  bool blocked = false;     ///< SUMO's, on foot before a ghost: it gets around that as ours
  double liked_offset = 0;  ///< beside its path, before it made for its lane's middle [m]
  HandBackWatch hand_back;
  DriverHold hold;
  std::string wish;          ///< of another client: "take", "release", or ""
  bool resumes = false;      ///< as PendingAgent::resumes
  bool keeps_place = false;  ///< it waits where it walked to, not where SUMO shows it
  double length = 0;         ///< 0 for persons, whose reference point is their centre [m]
  double min_gap = 0;        ///< of its vType; negative: not told [m]
  double max_speed = 0;      ///< vehicles [m/s]
  double speed_factor = 1;
  bool bicycle = false;
  double waited = 0;           ///< off the map for room, after SUMO had inserted it [s]
  LaneId sumo_lane = kNoLane;  ///< SUMO-driven: on which SUMO has it now
  double sumo_along = 0;       ///< and where on it its front, as SUMO counts [m]
  std::string lane_name;       ///< SUMO-driven: on which SUMO had it last
  LaneId lane = kNoLane;       ///< the same
  double looked_at = 0;        ///< when its path was last held against that lane [s]
  int stages_left = 0;         ///< persons that SUMO moves
  StopService service = StopService::None;
  double asked_at = 0;                           ///< when its service began [s]
  std::vector<SumoAgentDetails::Stop> stops;     ///< of its plan, as PathStop::plan counts
  std::string type_id;                           ///< SUMO's vType
  std::vector<std::string> route;                ///< SUMO's, as it was last known or told
  std::shared_ptr<const Trip> trip;              ///< the one that SUMO knows
  EdgeId edge = kNoEdge;                         ///< on which it was last shown to rerouters
  double reroute_period = -1, next_reroute = 0;  ///< of its rerouting device [s]
};

/// From its first place in the scene to its destination, in it or in a vehicle.
struct Journey {
  AgentId id;
  AgentTypeId type{};
  double departed = 0;  ///< [s]
};

}  // namespace sumogamma
