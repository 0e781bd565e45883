#pragma once

#include <array>
#include <vector>

#include "base/parallel.h"
#include "study/agent_track.h"
#include "study/offences/judges.h"
#include "study/offences/offence.h"

namespace sumogamma {

/// Traffic offences, judged from where agents are alone: the same yardstick for GAMMA's and SUMO's
/// agents. What each rule is stands with its judge (study/offences/judges.h).
class RuleMonitor {
 public:
  static constexpr double kPause = 1.0;  ///< [s]

  /// Both must outlive the monitor. `step`: time between two calls of add [s].
  RuleMonitor(double step, const RoadNetwork& network, const LaneLocator& locator,
              const TrafficCode& code = {})
      : step_(step), roads_(network, locator, code) {}

  /// The result is the same with any number of workers.
  void add(const Scene& scene, const AgentTypeTable& types, const RoadState& road,
           Workers& workers);

  RuleResult result(const AgentTypeTable& types) const;
  /// Red lights run with the last add.
  const std::vector<RedLightEvent>& new_events() const { return new_events_; }
  /// All offences so far, in order of their beginnings. Interruptions shorter than kPause don't end
  /// one.
  const std::vector<OffenceSpan>& offences() const { return offences_; }

 private:
  struct State {
    RuleMemory memory;
    std::array<std::int32_t, 4> span{-1, -1, -1, -1};  ///< by Offence: index of its last one
  };
  void gather(const Scene& scene, const AgentTypeTable& types, const Found& found);
  void extend(Offence kind, const Scene& scene, std::size_t row);
  void count_red_lights_met(const Scene& scene, const AgentTypeTable& types);

  double step_;
  RuleRoads roads_;
  AgentTrack<State> track_;
  std::vector<RuleCounts> by_type_;
  RoadState before_;  ///< signals of the previous tick
  std::vector<RedLightEvent> new_events_;
  std::vector<OffenceSpan> offences_;

  // scratch of one tick
  std::vector<RuleWork> work_;  ///< by worker
  std::vector<AtStopLine> at_stop_lines_, at_lines_by_lane_;
};

}  // namespace sumogamma
