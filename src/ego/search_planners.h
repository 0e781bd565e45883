#pragma once

#include <array>
#include <cstdint>

#include "ego/driving_problem.h"
#include "ego/planners.h"
#include "planning/paired_search.h"
#include "planning/search_budget.h"

namespace sumogamma {

/// Planners that reckon with what others may mean to do (docs/planning.md).
enum class SearchPlanner : std::uint8_t {
  PomdpGamma,    ///< belief tree; the others by GAMMA
  RolloutGamma,  ///< one action, then the default policy; the others by GAMMA
  PomdpSimple,   ///< belief tree; the others along their ways at constant speed
  Policy,        ///< the default policy alone
  Oracle,        ///< as PomdpGamma, but it knows everybody's way
};

/// Sizes of a plan.
struct PlanSize {
  std::uint32_t scenarios = 5;           ///< K
  std::uint32_t rollout_scenarios = 20;  ///< of RolloutGamma
  SearchParameters search{.depth = 12, .discount = 0.95, .gap_share = 0.97, .pruning = 0.001};
  std::int64_t scene_steps = 3000;  ///< a plan; counted, so that it is the same plan anywhere
  double deadline = 0;              ///< ends a search [s] on the clock; 0: none
  int trees = 1;                    ///< 2: each over half of the scenarios, in a thread of its own
};

struct SearchDecision {
  int action = 0;
  double acceleration = 0;  ///< [m/s^2]
  SearchStatistics statistics;
};

/// A planner with what it keeps from plan to plan: beliefs, and pools that stay warm.
class DrivingSearch {
 public:
  explicit DrivingSearch(SearchPlanner kind, PlanSize size = {}, DrivingParameters driving = {});

  /// Looks, and decides. To be called once a period; a pure function of the views so far.
  SearchDecision decide(const EgoView& view);
  const WayBeliefs& beliefs() const { return beliefs_; }
  const BeliefTree<DrivingProblem>& tree() const { return tree_; }

 private:
  bool is_paired(std::uint32_t scenarios) const {
    return size_.trees == 2 && scenarios >= 2 && kind_ != SearchPlanner::RolloutGamma;
  }
  void note(const EgoView& view, const PlanRoot& root, std::uint64_t key,
            const DrivingProblem& problem) const;

  SearchPlanner kind_;
  PlanSize size_;
  DrivingParameters driving_;
  OthersModel others_;
  WayBeliefs beliefs_;
  std::array<ForwardModel, 2> forward_;  ///< one a tree
  BeliefTree<DrivingProblem> tree_;
  PairedSearch<DrivingProblem> trees_;
  Workers workers_;
  std::vector<DrivingState> states_;
  std::vector<double> weights_;
};

/// For the table of planners.
Planner make_search_planner(SearchPlanner kind);

}  // namespace sumogamma
