#pragma once

#include <cstdint>
#include <vector>

#include "road/lane_locator.h"
#include "scene/agent_type.h"
#include "scene/road_state.h"
#include "scene/scene.h"
#include "scene/traffic_code.h"

namespace sumogamma {

/// A red light is met by a vehicle slower than kMeetsBelow whose front is within kMeetsWithin
/// before the end of a lane all of whose links show red, with nobody between it and that end; by
/// somebody on foot who enters a crossing after a second of standing beside it while it showed red;
/// and by all who run it. Once for an agent and a red lane's end or crossing that it gets past.
inline constexpr double kMeetsWithin = 12.0;  // [m]
inline constexpr double kMeetsBelow = 1.0;    // [m/s]

/// What the rules ask of the network, made once.
struct RuleRoads {
  /// Both must outlive it.
  RuleRoads(const RoadNetwork& network, const LaneLocator& locator, const TrafficCode& code);

  const RoadNetwork& network;
  const LaneLocator& locator;
  TrafficCode code;
  bool has_storeys;
  /// By LaneId: how far before the lane's end an agent may be whom the stop line there concerns
  /// [m]; negative: no signal guards the lane's end.
  std::vector<double> stop_reach;
  /// By LaneId: lanes from which the stop line of a signal may be passed next.
  std::vector<bool> by_signal;
};

/// What judges read of a tick. Everything in it is frozen: they may run in any order.
struct RuleView {
  const RuleRoads& roads;
  const Scene& scene;
  const AgentTypeTable& types;
  const RoadState& road;
  const RoadState& before;  ///< signals of the tick before
  double step;              ///< [s]
};

/// What is remembered of a vehicle at stop lines.
struct StopLineMemory {
  EdgeId red_met = kNoEdge;   ///< the edge at whose end it met a red light
  LaneId short_of = kNoLane;  ///< the lane beyond whose end it is, before its line
  LaneId passed = kNoLane;    ///< the lane with mixed lights whose end it passed
  double passed_at = 0;       ///< [s]
  Vec2 passed_place = Vec2::Zero();
  std::vector<ConnectionId> was_red;  ///< links of `passed` that showed red then
};

/// What is remembered of somebody on foot at crossings.
struct CrossingMemory {
  LaneId on = kNoLane;                ///< the crossing that it is on, or beside
  bool amid = false;                  ///< not near an end of it when it last was on it
  double last_on = 0;                 ///< when that was [s]
  LaneId at_end_of = kNoLane;         ///< the crossing on whose first half metre it is
  bool stepped_on_red = false;        ///< that it showed red when it came there
  double waited = 0;                  ///< stood beside `red` [s]
  std::vector<LaneId> red_crossings;  ///< that showed red meanwhile
};

/// What judges remember of one agent from tick to tick. Each writes its own part.
struct RuleMemory {
  bool known = false;            ///< seen in the tick before: what follows holds
  Vec2 position = Vec2::Zero();  ///< of the centre then [m]
  double heading = 0;            ///< [rad]
  StopLineMemory stop_line;      ///< vehicles
  CrossingMemory crossing;       ///< on foot
  double path_along = 0;         ///< on foot: on its path [m]
};

/// What may be found of an agent in a tick.
enum class Finding : std::uint8_t {
  SignalPassed,  ///< a signalled stop line or crossing entered, whatever it showed
  RedLightMet,
  RedLightRun,
  RoadCrossed,  ///< on foot between junctions
  WrongWay,     ///< for this tick, as the rest
  Overtaking,
  OffRoad,
  Sidewalk,
};

struct Found {
  std::uint32_t row = 0;
  Finding what{};
  Vec2 place = Vec2::Zero();                ///< RedLightRun: where [m]
  ConnectionId connection = kNoConnection;  ///< RedLightRun: which
};

/// A front near the end of a lane with signals, in that end's coordinates.
struct AtStopLine {
  LaneId lane = kNoLane;
  std::uint32_t row = 0;
  double along = 0;   ///< <= 0 before the line [m]
  double offset = 0;  ///< positive left [m]
  double half_width = 0;
  bool could_go = false;  ///< it hardly moves, and all the lane's links show red
};

/// The links for vehicles behind a lane's stop line that have a signal.
struct StopLineLights {
  LaneId lane = kNoLane;
  std::size_t links = 0;
  std::vector<ConnectionId> red;  ///< those that show red

  bool all_red() const { return red.size() == links; }
};

/// What one worker found, in order of rows, and its scratch.
struct RuleWork {
  std::vector<Found> found;
  std::vector<AtStopLine> at_stop_lines;

  std::vector<LaneHit> hits;
  StopLineLights lights, lights_beside;
};

/// Judges one agent by one rule: reads the view and the agent's memory, writes its own part of that
/// and what it finds.
using Judge = void (*)(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work);

/// Vehicles: on no road, against all lanes, on ground for people on foot (ground.cpp).
void judge_ground(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work);

/// Vehicles: the front passes a signalled lane's end in its direction, and the link that it then
/// takes showed red before and after that step (so a light that changes within the step is nobody's
/// fault). Where the lane's links don't show the same, judge_turn decides.
void judge_stop_line(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work);
/// Vehicles that passed a stop line whose links showed different lights: judged by the edge that
/// one of them leads to, once they are on it.
void judge_turn(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work);

/// On foot: the centre gets half a metre deep into a signalled crossing that showed red already
/// when it was stepped on; who is pressed off it sideways and comes back in time is still on it,
/// and who keeps to a sidewalk or walking area that lies over a crossing's end isn't on it.
void judge_crossing(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work);

/// On foot: the pieces of a walk over a road (Path::over_road) that were walked to their end. Only
/// a path says what somebody means: plain SUMO's people have none.
void judge_mid_block(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work);

/// The rules. A new one is a file, and a line here.
inline constexpr Judge kOfVehicles[] = {judge_ground, judge_stop_line, judge_turn};
inline constexpr Judge kOnFoot[] = {judge_crossing, judge_mid_block};

}  // namespace sumogamma
