#include "ego/search_planners.h"

#include <chrono>
#include <memory>

#include "base/random.h"

namespace sumogamma {

namespace {

PlanSize size_of(const EgoSettings& settings) {
  PlanSize size;
  size.scenarios = static_cast<std::uint32_t>(settings.scenarios);
  size.search.depth = settings.depth;
  size.scene_steps = settings.scene_steps;
  size.deadline = settings.deadline;
  size.trees = settings.trees;
  return size;
}

}  // namespace

DrivingSearch::DrivingSearch(SearchPlanner kind, PlanSize size, DrivingParameters driving)
    : kind_(kind),
      size_(size),
      driving_(driving),
      others_(kind == SearchPlanner::PomdpSimple ? OthersModel::ConstantSpeed : OthersModel::Gamma),
      beliefs_(others_),
      workers_(static_cast<std::size_t>(size.trees)) {
  driving_.discount = size_.search.discount;
}

SearchDecision DrivingSearch::decide(const EgoView& view) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const bool knows = kind_ == SearchPlanner::Oracle, rolls = kind_ == SearchPlanner::RolloutGamma;
  for (int tree = 0; tree < size_.trees; ++tree)
    forward_[static_cast<std::size_t>(tree)].follow(view.world.model);
  // the default policy looks at where everybody is and how fast, whatever they mean
  if (!knows && kind_ != SearchPlanner::Policy) beliefs_.observe(view, forward_[0]);
  const PlanRoot root = plan_root(view, beliefs_, knows, driving_.observed);
  DrivingProblem problem(view, root, others_, driving_, forward_[0]);

  const std::uint32_t count = rolls ? size_.rollout_scenarios : size_.scenarios;
  const std::uint64_t key =
      random_bits(view.seed, 0, static_cast<std::uint64_t>(view.plan), Draw::Scenario);
  states_.resize(count);
  weights_.assign(count, 1.0 / count);
  for (std::uint32_t i = 0; i < count; ++i)
    draw_scenario(forward_[0].model(), root, key, i, count, states_[i]);
  SearchParameters parameters = size_.search;
  SearchBudget budget{.steps = size_.scene_steps};
  if (rolls) {  // each action once, and what the default policy makes of it
    parameters.pruning = 0;
    budget = {.expansions = 1};
  }
  if (size_.deadline > 0)
    budget.stop = [end = begin + std::chrono::duration<double>(size_.deadline)] {
      return Clock::now() > end;
    };
  SearchResult found;
  if (kind_ == SearchPlanner::Policy) {
    const std::vector<SearchParticle> particle = {{1.0, 0, 0, 0}};
    found.action = problem.default_action(ScenarioGroup<DrivingState>(particle, states_.data()));
    found.statistics.by_default = true;
  } else if (size_.trees == 2 && count >= 2 && !rolls) {
    DrivingProblem other(view, root, others_, driving_, forward_[1]);
    found =
        trees_.search({&problem, &other}, {states_, weights_, key}, parameters, budget, workers_);
  } else {
    found = tree_.search(problem, {states_, weights_, key}, parameters, budget);
  }
  return {found.action, problem.acceleration_of(found.action), found.statistics};
}

Planner make_search_planner(SearchPlanner kind) {
  return [kind, search = std::shared_ptr<DrivingSearch>()](const EgoView& view) mutable {
    if (!search) search = std::make_shared<DrivingSearch>(kind, size_of(view.settings));
    const SearchDecision decision = search->decide(view);
    EgoAction action;
    action.acceleration = decision.acceleration;
    action.search = decision.statistics;
    return action;
  };
}

}  // namespace sumogamma
