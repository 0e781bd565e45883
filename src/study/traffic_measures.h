#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "road/road_network.h"
#include "scene/agent_type.h"
#include "scene/scene.h"
#include "study/agent_track.h"

namespace sumogamma {

/// Time spent and way covered within a piece of road and time.
struct Presence {
  double time = 0;      ///< agents' time, summed [s]
  double distance = 0;  ///< [m]
  double waiting = 0;   ///< of `time`, slower than FlowMonitor::kWaiting [s]
  double delay = 0;     ///< TrafficMonitor has what it is [s]

  void add(const Presence& more) {
    time += more.time;
    distance += more.distance;
    waiting += more.waiting;
    delay += more.delay;
  }
};

/// Flow, density and speed of a lane over a time by Edie's (1963) definitions: way covered, and
/// time spent, over length times duration; they obey flow = density * speed exactly.
struct EdieFigures {
  double flow = 0;          ///< [1/s]
  double density = 0;       ///< [1/m]
  double area_density = 0;  ///< time spent over area times duration [1/m^2]
  double speed = 0;         ///< [m/s]; 0 where nobody was there
};
/// `length` [m] and `area` [m^2] of the ground, 0 where it has none of either: then these figures
/// are 0. `duration` > 0 [s].
EdieFigures edie_figures(const Presence& presence, double length, double area, double duration);

/// One lane and type of an interval. Lanes and types without anybody aren't there.
struct LaneInterval {
  double begin = 0, end = 0;  ///< [s]
  LaneId lane = kNoLane;
  AgentTypeId type{};
  Presence presence;
};

/// Everybody of a type in an interval.
struct TypeInterval {
  double begin = 0, end = 0;  ///< [s]
  AgentTypeId type{};
  Presence presence;
  std::uint64_t entered = 0, left = 0;
};

/// What became of one agent.
struct AgentJourney {
  AgentId id;
  AgentTypeId type{};
  double entered = 0, left = -1;  ///< [s]; -1: still there in the end
  Presence presence;
};

/// Keys of `traffic` in results.json.
struct TrafficResult {
  double interval = 0;                           ///< of lanes.csv and traffic.csv [s]
  double delay_mean = 0;                         ///< over agents, those under way included [s]
  double delay_per_km = 0;                       ///< [s/km]
  std::map<std::string, double> mode_share;      ///< of agents, by type
  std::map<std::string, double> distance_share;  ///< of the way covered, by type
};

/// Sums by lane, type and interval, and by agent, whoever drives.
///
/// Delay is SUMO's time loss: time that driving more slowly than possible costs, (1 - v / v_free)
/// of each step. v_free is the lane's limit or the type's greatest speed, whichever is less; on
/// foot the type's preferred speed. No delay where no lane is, off the road (parked) and at planned
/// halts.
class TrafficMonitor {
 public:
  /// `step`: time between two calls of add [s]; `interval` > 0 [s]. `network` must outlive the
  /// monitor.
  TrafficMonitor(double step, const RoadNetwork& network, double interval);

  void add(const Scene& scene, const AgentTypeTable& types);

  /// In order of begin, lane, type. The last interval ends with the run.
  std::vector<LaneInterval> lanes() const;
  /// In order of begin, type.
  std::vector<TypeInterval> types() const;
  /// In order of leaving, then of id.
  std::vector<AgentJourney> journeys() const;
  TrafficResult result(const AgentTypeTable& types) const;

 private:
  struct State {
    bool known = false;
    AgentTypeId type{};
    double entered = 0;
    Presence presence;
  };
  Presence step_of(const Scene& scene, const AgentTypeTable& types, std::size_t row) const;
  void begin_interval(double time);
  void append_lanes(std::vector<LaneInterval>& all) const;
  void append_types(std::vector<TypeInterval>& all) const;

  double step_;
  const RoadNetwork& network_;
  double interval_, begin_ = 0, now_ = 0;
  bool begun_ = false;
  AgentTrack<State> track_;
  std::map<std::pair<std::int32_t, AgentTypeId>, Presence> lane_now_;
  std::map<AgentTypeId, TypeInterval> type_now_;
  std::vector<LaneInterval> lanes_;
  std::vector<TypeInterval> types_;
  std::vector<AgentJourney> left_;
};

}  // namespace sumogamma
