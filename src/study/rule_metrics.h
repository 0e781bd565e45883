#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "road/lane_locator.h"
#include "scene/agent_type.h"
#include "scene/road_state.h"
#include "scene/scene.h"
#include "study/agent_track.h"

namespace sumogamma {

/// Counts of one type, or of everybody.
struct RuleCounts {
  std::uint64_t red_light_crossings =
      0;  ///< stop lines or crossings entered while their link showed red
  std::uint64_t signal_crossings =
      0;  ///< all signalled stop lines or crossings entered, whatever they showed
  std::uint64_t red_lights_met =
      0;  ///< encounters of an agent that could go with a red light: the base of a rate of running
  std::uint64_t mid_block_crossings = 0;  ///< roads crossed on foot between junctions
  double wrong_way_s = 0;                 ///< against every lane of the place
  double overtaking_s = 0;                ///< likewise, but past somebody narrow: no offence
  double off_road_s = 0;                  ///< on no lane and no junction
  double sidewalk_by_vehicle_s = 0;       ///< motor vehicles on ground for people on foot
};

/// Keys of `rules` in results.json.
struct RuleResult {
  RuleCounts all;
  std::map<std::string, RuleCounts> by_type;
};

enum class Offence : std::uint8_t { RedLight, WrongWay, OffRoad, Sidewalk };

/// One agent's offence from its beginning to its end, for offences.csv: where to look when a count
/// surprises.
struct OffenceSpan {
  Offence kind = Offence::RedLight;
  AgentId id;
  AgentTypeId type{};
  Vec2 position = Vec2::Zero();  ///< at its beginning [m]
  double since = 0;              ///< [s]
  double duration = 0;           ///< 0 for a red light [s]
};

/// A red light that was run: for the replay.
struct RedLightEvent {
  double time = 0;
  AgentId id;
  Vec2 position = Vec2::Zero();
  ConnectionId connection = kNoConnection;
};

/// Traffic offences, judged from where agents are alone: the same yardstick for GAMMA's and SUMO's
/// agents.
///
/// Red light, vehicles: the front passes a signalled lane's end in its direction, and the link that
/// it then takes showed red before and after that step (so a light that changes within the step is
/// nobody's fault). Where the lane's links don't show the same, judgement waits until the vehicle
/// is on an edge that one of them leads to. Red light, pedestrians: the centre gets kEntered deep
/// into a signalled crossing that showed red already when it was stepped on; who is pressed off it
/// sideways and comes back within kAside is still on it, and who keeps to a sidewalk or walking
/// area that lies over a crossing's end isn't on it. Wrong way: forward and faster than kMoving, on
/// a normal lane, off junctions, more than 120 degrees from every lane of the place that vehicles
/// may use. Neither that nor a sidewalk counts for a centre that is over the edge by less than
/// kOver. Lanes on another storey than one's own don't count (bridges). Overtaking: the same, on
/// a lane that the network calls the opposite one of a lane on which somebody narrow goes the same
/// way, no further off than kBeside, or ahead and reached within kSoon, and no more than kFaster
/// faster.
///
/// Roads crossed between junctions: the pieces of a walk over a road (Path::over_road) that were
/// walked to their end. Only a path says what somebody means: plain SUMO's people have none.
///
/// A red light is met by a vehicle slower than kSlow whose front is within kMeets before the end of
/// a lane all of whose links show red, with nobody between it and that end; by somebody on foot who
/// enters a crossing after a second of standing beside it while it showed red; and by all who run
/// it. Once for an agent and a red lane's end or crossing that it gets past.
class RuleMonitor {
 public:
  static constexpr double kMeets = 12.0;   ///< [m]
  static constexpr double kSlow = 1.0;     ///< [m/s]
  static constexpr double kWaits = 1.0;    ///< [s]
  static constexpr double kStands = 0.2;   ///< [m/s]
  static constexpr double kMoving = 0.5;   ///< [m/s]
  static constexpr double kOver = 0.1;     ///< [m]
  static constexpr double kEntered = 0.5;  ///< [m]
  static constexpr double kGap = 0.5;      ///< [m]
  static constexpr double kBeside = 20.0;  ///< from middle to middle [m]
  static constexpr double kSoon = 4.0;     ///< [s]
  static constexpr double kFaster = 1.0;   ///< [m/s]
  static constexpr double kAside = 10.0;   ///< [s]
  static constexpr double kPause = 1.0;    ///< [s]
  static constexpr double kJudgement =
      30.0;  ///< a mixed stop line is dropped unjudged after so long [s]

  /// Both must outlive the monitor.
  RuleMonitor(double step, const RoadNetwork& network, const LaneLocator& locator);

  void add(const Scene& scene, const AgentTypeTable& types, const RoadState& road);

  RuleResult result(const AgentTypeTable& types) const;
  /// Red lights run with the last add.
  const std::vector<RedLightEvent>& new_events() const { return new_events_; }
  /// All offences so far, in order of their beginnings. Interruptions shorter than kPause don't end
  /// one.
  const std::vector<OffenceSpan>& offences() const { return offences_; }

 private:
  struct State {
    bool known = false;
    Vec2 front = Vec2::Zero(), center = Vec2::Zero();
    LaneId on_crossing = kNoLane;  ///< pedestrians: the signalled crossing they are on, or beside
    double along = 0;              ///< pedestrians: on their path [m]
    bool amid = false;             ///< not near an end of it when they last were on it
    double last_on = 0;            ///< when that was [s]
    EdgeId red_met = kNoEdge;      ///< vehicles: the edge at whose end they met a red light
    LaneId short_of = kNoLane;    ///< vehicles: the lane beyond whose end they are, before its line
    LaneId at_end_of = kNoLane;   ///< pedestrians: the crossing on whose first half metre they are
    bool stepped_on_red = false;  ///< that it showed red when they came there
    double waited = 0;            ///< pedestrians: stood beside `red_crossings` [s]
    std::vector<LaneId> red_crossings;  ///< that showed red meanwhile
    LaneId passed = kNoLane;  ///< vehicles: the lane with mixed lights whose end they passed
    double passed_at = 0;
    Vec2 passed_place = Vec2::Zero();
    std::vector<ConnectionId> was_red;                 ///< links of `passed` that showed red then
    std::array<std::int32_t, 4> span{-1, -1, -1, -1};  ///< by Offence: index of its last one
  };
  struct Row {  ///< what the judging of one agent needs
    const Scene& scene;
    std::size_t row;
    const AgentType& type;
    RuleCounts& counts;
  };
  /// Does an agent on a lane that leads the other way get past somebody narrow?
  bool overtakes(const Row& agent, const LaneHit& hit) const;
  /// What a point of the ground is to a vehicle.
  struct Place {
    bool none = false;               ///< no lane of any kind
    bool junction = false;           ///< within the outline of one
    std::optional<LaneHit> against;  ///< lanes lead the other way alone; one of them
    bool walkway = false;            ///< people walk there, and no motor vehicle drives
  };
  /// Does an agent drive on its own lane, the way that it leads? Nothing else of the place matters
  /// to it then.
  bool keeps_its_lane(const Row& agent) const;
  Place place_at(const Row& agent, const Vec2& point);
  /// Is a point that is on no lane and no junction between two pieces of road?
  bool in_gap(const Row& agent, const Vec2& point);
  void judge_ground(const Row& agent, State& state);
  void extend(Offence kind, const Row& agent, State& state);
  void judge_stop_line(const Row& agent, State& state, const Vec2& front, const RoadState& road);
  void judge_turn(const Row& agent, State& state);
  /// Is somebody on foot on the sidewalk or walking area that it uses (hits_ are its lanes)?
  bool is_on_its_walkway(const Row& agent) const;
  void judge_crossing(const Row& agent, State& state, const RoadState& road);
  void judge_mid_block(const Row& agent, State& state, const RoadState& road);
  void find_lanes(const Row& agent, const Vec2& point, std::vector<LaneHit>& hits) const;
  bool shows_red(const Lane& crossing, const RoadState& road) const;
  bool was_and_is_red(const Connection& connection, const RoadState& road) const;
  void record_red(const Row& agent, State& state, const Vec2& place, ConnectionId connection);
  std::size_t find_red_links(const Lane& lane, const RoadState& road,
                             std::vector<ConnectionId>& red) const;
  void count_red_lights_met();
  void note_waiting(State& state, const RoadState& road);

  double step_;
  const RoadNetwork& network_;
  const LaneLocator& locator_;
  bool has_storeys_;
  std::vector<bool> by_signal_;  ///< lanes from which the stop line of a signal may be passed next
  AgentTrack<State> track_;
  std::vector<RuleCounts> by_type_;
  RoadState before_;  ///< signals of the previous tick
  std::vector<RedLightEvent> new_events_;
  std::vector<OffenceSpan> offences_;
  std::vector<LaneHit> hits_, front_hits_;
  std::vector<ConnectionId> red_links_, beside_red_;
  /// A front near the end of a lane with signals, in that end's coordinates.
  struct AtLine {
    LaneId lane = kNoLane;
    std::size_t row = 0;
    double along = 0, offset = 0, half_width = 0;  ///< along: <= 0 before the line [m]
    RuleCounts* meets = nullptr;  ///< where it is counted; null: it moves, or no red
  };
  std::vector<AtLine> at_lines_;
};

}  // namespace sumogamma
