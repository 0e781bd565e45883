#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ego/closed_loop_score.h"
#include "ego/ego_driver.h"
#include "ego/ego_metrics.h"

namespace sumogamma {

/// How an episode ended.
namespace outcome {
inline constexpr const char *kGoal = "goal", *kCollision = "collision", *kTime = "time",
                            *kLost = "lost",  ///< the world took the ego out before its goal
                                *kClientFailed = "client_failed";
}  // namespace outcome

/// All that is kept of an episode. Everything but the wall times follows from scenario, settings,
/// seed and planner.
struct EpisodeResult {
  std::uint64_t seed = 0;
  std::string outcome;
  std::string failure;  ///< of the client
  Vec2 start = Vec2::Zero();
  double start_heading = 0;      ///< [rad]
  double way = 0;                ///< from the start to the goal [m]
  std::uint64_t world_hash = 0;  ///< everybody's state up to the ego's first action
  std::uint64_t state_hash = 0;  ///< the same up to the end
  std::size_t others = 0;        ///< agents in the scene at the start
  double restricted_time = 0;    ///< to the goal; the limit where it isn't reached [s]
  EgoMetrics metrics;
  ClosedLoopScore score;
  std::optional<EgoContact> contact;
  std::string contact_type;  ///< of the other
  std::vector<PlanRow> plans;
  std::int64_t late = 0;                ///< actions of the client that didn't come in time
  int detours = 0, detours_missed = 0;  ///< round what stood in its way; searches that found none
  bool gridlock = false;
  std::vector<double> planning_times;  ///< [s] on the wall
  double wall = 0;                     ///< of the episode [s]
};

/// Has the place locked up: over half of the vehicles in the window slower than 0.2 m/s for 30 s on
/// end, while the ego is not within 15 m of their middle?
class GridlockWatch {
 public:
  GridlockWatch(std::vector<double> window, double step)
      : window_(std::move(window)), step_(step) {}
  /// `ego`: its row, or the scene's size before it came.
  void add(const AgentTypeTable& types, const Scene& scene, std::size_t ego);
  bool found() const { return found_; }

 private:
  std::vector<double> window_;
  double step_, locked_ = 0;
  bool found_ = false;
};

/// Wilson's interval of a share, 95 % [low, high]; the whole of [0, 1] where n is 0.
struct ShareInterval {
  double low = 0, high = 1;
};
ShareInterval wilson_interval(std::size_t count, std::size_t n);

}  // namespace sumogamma
