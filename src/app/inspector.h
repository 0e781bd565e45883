#pragma once

#include <span>
#include <vector>

#include "app/run_plan.h"
#include "io/replay_stream.h"
#include "simulation/simulation.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

/// Looks into the model's decision for the agents of --inspect: what Eq. 7 and the guard make of
/// the frozen scene, by the very function that then moves them. No more than kMostAgents at once,
/// in order of arrival, and no more than kMostPlanes in a run; both are said where they are met.
class Inspector {
 public:
  static constexpr std::size_t kMostAgents = 16;
  static constexpr std::size_t kMostPlanes = 10'000'000;  ///< some 50 MB of a recording, unpacked

  /// What is handed over must outlive it.
  Inspector(const RunPlan& plan, const Simulation& sim, SumoWorld& world)
      : plan_(plan), sim_(sim), world_(world) {}

  /// Velocity spaces of the present tick. Between observing and moving alone; computed once a tick.
  std::span<const InspectedAgent> spaces();
  /// Says so where nobody of those asked for was ever there.
  void close() const;

 private:
  bool is_wanted(std::size_t row);
  void look_at(std::size_t row);
  void count_planes();

  const RunPlan& plan_;
  const Simulation& sim_;
  SumoWorld& world_;
  std::int64_t tick_ = -1;
  std::vector<signed char> wanted_;  ///< by id: -1 not asked yet
  std::vector<InspectedAgent> agents_;
  std::size_t count_ = 0, planes_ = 0;
  bool told_of_number_ = false, seen_ = false;
};

}  // namespace sumogamma
