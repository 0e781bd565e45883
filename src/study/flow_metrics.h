#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/agent_type.h"
#include "scene/road_state.h"
#include "scene/scene.h"
#include "scene/wait_graph.h"
#include "study/agent_track.h"
#include "study/red_lights.h"

namespace sumogamma {

/// Keys of `flow` in results.json.
struct FlowResult {
  double mean_speed = 0;            ///< over all agent-steps [m/s]
  double distance_km = 0;           ///< covered by all agents together
  std::uint64_t stuck_agents = 0;   ///< agents that were ever stuck
  double longest_standstill_s = 0;  ///< longest standing without a red light ahead
  std::uint64_t held_agents = 0;    ///< agents that were ever held
  double longest_held_s = 0;        ///< longest stay within kHeldWithin, planned halts left out
  double waiting_time_mean_s =
      0;  ///< vehicles: time under kWaiting per trip, trips under way included
  std::map<std::string, double> mean_speed_by_type;  ///< [m/s]
};

/// One standstill of at least kStuckTime, for stuck.csv, or one stay of at least kHeldTime, for
/// held.csv.
struct StuckAgent {
  AgentId id;
  AgentTypeId type{};
  Vec2 position = Vec2::Zero();  ///< where it stood when it became stuck, or held [m]
  LaneId lane = kNoLane;
  double since = 0;                        ///< when it stopped, or came there [s]
  double standing = 0;                     ///< as far as it counts, in the end or so far [s]
  bool moved_on = false;                   ///< false: still stuck in the end, or gone while stuck
  LimitReason reason = LimitReason::None;  ///< at that moment; None for agents that SUMO drives
  std::int64_t foe = -1;                   ///< id of the agent that it waited for, -1 where unknown
  /// Who waits for nobody, at the end of the chain from `foe` on; -1 where there is no foe, or
  /// where the chain closes to a ring.
  std::int64_t head = -1;
  LimitReason head_reason = LimitReason::None;  ///< why that one waited
  bool ring = false;
};

/// Speeds, distances and standstills. An agent stands below kStanding, and as long as it stays
/// within kInPlace of where it came to a stand: who shuffles to and fro gets nowhere. Standing time
/// counts while no red light is ahead, be it of the last of those who wait for one another from it
/// on, and no planned halt is on; a red light suspends the count and
/// only moving resets it, so that a queue which doesn't move through several cycles is found out.
///
/// An agent is held that got no further than kHeldWithin from where it was in kHeldTime, whatever
/// the reason: red lights count, rocking to and fro doesn't help, only a planned halt suspends the
/// count. So two that stand nose to nose over every red light are found, and so is who waits at one
/// light for several cycles.
class FlowMonitor {
 public:
  static constexpr double kStanding = 0.2;    ///< [m/s]
  static constexpr double kInPlace = 1.0;     ///< [m]
  static constexpr double kStuckTime = 60.0;  ///< [s]
  static constexpr double kHeldWithin = 4.0;  ///< [m]
  static constexpr double kHeldTime = 100.0;  ///< [s]
  static constexpr double kWaiting = 0.1;     ///< SUMO's threshold of waiting time [m/s]

  /// `network` must outlive the monitor.
  FlowMonitor(double step, const RoadNetwork& network) : step_(step), red_lights_(network) {}

  void add(const Scene& scene, const AgentTypeTable& types, const RoadState& road,
           const WaitGraph& waits);

  FlowResult result(const AgentTypeTable& types) const;
  /// In order of becoming stuck.
  const std::vector<StuckAgent>& stuck() const { return stuck_; }
  /// Stays of those who were held, in order of becoming so.
  const std::vector<StuckAgent>& held() const { return held_; }
  /// Agents stuck at the last tick.
  std::size_t stuck_now() const { return stuck_now_; }

 private:
  struct State {
    bool known = false, stands = false;
    bool ever_stuck = false;
    std::int32_t record = -1;  ///< index into stuck_ of the present standstill
    Vec2 position = Vec2::Zero(), stopped = Vec2::Zero();
    double stopped_at = 0, standing = 0;
    bool ever_held = false;
    std::int32_t held_record = -1;  ///< index into held_ of the present stay
    Vec2 stays_at = Vec2::Zero();
    double stays_since = 0, stays = 0;
  };
  void add_standing(const WaitGraph& waits, const Scene& scene, std::size_t row, State& state);
  void add_stay(const WaitGraph& waits, const Scene& scene, std::size_t row, State& state);

  double step_;
  RedLights red_lights_;
  AgentTrack<State> track_;
  std::vector<StuckAgent> stuck_, held_;
  struct Sums {
    double speed = 0;
    std::uint64_t steps = 0;
  };
  std::vector<Sums> by_type_;
  double distance_ = 0, longest_ = 0, longest_held_ = 0, waiting_ = 0;
  std::uint64_t stuck_agents_ = 0, held_agents_ = 0, vehicles_ = 0;
  std::size_t stuck_now_ = 0;
};

}  // namespace sumogamma
