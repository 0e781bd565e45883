#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "ego/plan_trace.h"
#include "ego/planners.h"

namespace sumogamma {

/// One plan of an episode.
struct PlanRow {
  std::int64_t plan = 0;
  double time = 0;  ///< since the episode's begin [s]
  Vec2 position = Vec2::Zero();
  double heading = 0, speed = 0, progress = 0;
  EgoAction action;
  int emergency_ticks = 0;  ///< until the next plan, in which the emergency brake had the word
};

/// Who decides, and what it decides about.
struct EgoTask {
  const EgoSettings& settings;
  EgoGoal goal;
  std::uint64_t seed = 1;
  double step = 0.05;  ///< of the world [s]
  bool rules = true;
  /// Told of every plan; empty: nobody looks on, and planners note nothing.
  std::function<void(const PlanTrace&)> look_on = {};
};

/// The ego's driver: asks the planner at the first tick at or after every k / rate seconds and does
/// at every tick what was planned. To be called as Simulation::planned.
class EgoDriver {
 public:
  EgoDriver(EgoTask task, Workers& workers, Planner planner)
      : task_(std::move(task)), workers_(workers), planner_(std::move(planner)) {}

  Vec2 operator()(const TrafficView& world, std::size_t row);

  /// Does it plan at this tick?
  bool is_due() const;
  /// Told after every tick: what the ego has made along its way so far [m].
  void set_progress(double progress) { progress_ = progress; }
  const std::vector<PlanRow>& plans() const { return plans_; }
  /// Wall time of the plans, in order [s].
  const std::vector<double>& planning_times() const { return times_; }
  double since() const { return static_cast<double>(ticks_) * task_.step; }

 private:
  void plan(const TrafficView& world, std::size_t row);

  EgoTask task_;
  Workers& workers_;
  Planner planner_;
  std::int64_t ticks_ = 0;
  double planned_at_ = 0;
  double progress_ = 0;
  std::vector<PlanRow> plans_;
  std::vector<double> times_;
};

/// Would a row, braking as hard as it can from now on, touch a body where that is now? Its box is
/// wider by 0.3 m, and longer by its braking way and 0.3 m.
bool must_brake_now(const Model& model, const Scene& scene, std::size_t row);

}  // namespace sumogamma
