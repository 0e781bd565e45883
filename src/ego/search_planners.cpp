#include "ego/search_planners.h"

#include <chrono>
#include <memory>

#include "base/random.h"
#include "ego/plan_trace.h"

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
  } else if (is_paired(count)) {
    DrivingProblem other(view, root, others_, driving_, forward_[1]);
    found =
        trees_.search({&problem, &other}, {states_, weights_, key}, parameters, budget, workers_);
  } else {
    found = tree_.search(problem, {states_, weights_, key}, parameters, budget);
  }
  if (view.trace != nullptr && kind_ != SearchPlanner::Policy) note(view, root, key, problem);
  return {found.action, problem.acceleration_of(found.action), found.statistics};
}

/// What was believed, drawn and found.
void DrivingSearch::note(const EgoView& view, const PlanRoot& root, std::uint64_t key,
                         const DrivingProblem& problem) const {
  PlanTrace& trace = *view.trace;
  const auto count = static_cast<std::uint32_t>(states_.size());
  trace_beliefs(view.world.model.types, root, size_.search.depth * ForwardModel::kStep, trace);
  trace_scenarios(root, key, count, trace);
  trace.figures = PlanTrace::Figures::Values;
  for (int action = 0; action < std::ssize(view.settings.accelerations); ++action) {
    const NodeBounds bounds = is_paired(count) ? trees_.bounds_of(action) : tree_.bounds_of(action);
    trace.choices.push_back({problem.acceleration_of(action), bounds.lower, bounds.upper});
  }
  const BeliefTree<DrivingProblem>& tree = is_paired(count) ? trees_.tree(0) : tree_;
  for (const BeliefNode& node : tree.beliefs()) {
    PlanTrace::TreeNode traced{
        -1, 0, node.depth, node.weight, node.bounds.lower, node.bounds.upper};
    if (node.parent != kNoNode) {
      const ActionNode& action = tree.action_nodes()[node.parent];
      traced.parent = static_cast<std::int32_t>(action.parent);
      traced.acceleration = problem.acceleration_of(action.action);
    }
    trace.tree.push_back(traced);
  }
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
