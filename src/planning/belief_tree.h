#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <concepts>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/random.h"
#include "planning/search_budget.h"

namespace sumogamma {

/// What one step of one scenario brings.
struct StepOutcome {
  double reward = 0;
  std::uint64_t observation = 0;  ///< scenarios that share it share the next action
  bool ended = false;             ///< nothing comes after this step
};

/// A scenario in a belief node.
struct SearchParticle {
  double weight = 0;
  std::uint32_t scenario = 0;  ///< number of its stream of draws
  std::uint32_t state = 0;     ///< index into the states that it belongs to
  std::uint64_t observation = 0;
};

/// Scenarios that look the same to the planner: what a policy may depend on.
template <class State>
class ScenarioGroup {
 public:
  ScenarioGroup(std::span<const SearchParticle> particles, const State* states)
      : particles_(particles), states_(states) {}

  std::size_t size() const { return particles_.size(); }
  const State& state(std::size_t index) const { return states_[particles_[index].state]; }
  double weight(std::size_t index) const { return particles_[index].weight; }
  std::uint32_t scenario(std::size_t index) const { return particles_[index].scenario; }

 private:
  std::span<const SearchParticle> particles_;
  const State* states_;
};

/// What a belief tree is searched over. Bounds are values of a single scenario from its state on,
/// undiscounted to that state:
/// - step: moves the state on under an action; `draw` in [0, 1) is all the chance there is;
/// - actions: legal ones, ascending and not empty; what they point to holds until the next call;
/// - default_action: the default policy's, whose value is the lower bound;
/// - value_at_end: lower bound on what comes after the search's depth;
/// - default_value (only where it is known): of the default policy from a state on, which spares
///   rolling it out;
/// - upper_bound: no policy gets more in so many steps and what comes after them, even one that
///   knows the state and all draws.
/// States are copied by assignment into states that were in use before.
template <class P>
concept BeliefProblem = requires(P& problem, typename P::State& state,
                                 const typename P::State& seen,
                                 const ScenarioGroup<typename P::State>& group) {
  { problem.step(state, int{}, double{}) } -> std::same_as<StepOutcome>;
  { problem.actions(group) } -> std::convertible_to<std::span<const int>>;
  { problem.default_action(group) } -> std::same_as<int>;
  { problem.value_at_end(seen) } -> std::convertible_to<double>;
  { problem.upper_bound(seen, int{}) } -> std::convertible_to<double>;
};

template <class P>
concept KnowsDefaultValue = requires(P& problem, const typename P::State& seen) {
  { problem.default_value(seen) } -> std::convertible_to<double>;
};

/// The belief of a search: one weight and one state a scenario.
template <class State>
struct Scenarios {
  std::span<const State> states;
  std::span<const double> weights;  ///< add up to 1
  std::uint64_t seed = 0;           ///< of the draws, with the scenario's number and the depth
  std::uint32_t first = 0;          ///< number of the first scenario
};

/// Bounds on the value of a node, discounted to the root and weighted by its scenarios:
/// lower <= upper with regularisation, and `utility`, an upper one without.
struct NodeBounds {
  double lower = 0, upper = 0, utility = 0;

  double gap() const { return upper - lower; }
  /// Takes in bounds that were found out otherwise: none is ever loosened, and lower <= upper.
  /// Did that change anything?
  bool tighten(double new_lower, double new_upper, double new_utility) {
    const NodeBounds old = *this;
    upper = std::max(std::min(upper, new_upper), lower);
    lower = std::min(std::max(lower, new_lower), upper);
    utility = std::min(utility, new_utility);
    return upper != old.upper || lower != old.lower || utility != old.utility;
  }
};

inline constexpr std::uint32_t kNoNode = ~std::uint32_t{0};

/// Scenarios after a history of actions and observations.
struct BeliefNode {
  NodeBounds bounds;
  double default_value = 0;        ///< of the default policy, discounted to the root and weighted
  double weight = 0;               ///< of its scenarios
  std::uint32_t parent = kNoNode;  ///< action node
  std::uint32_t first_action = kNoNode;  ///< its actions lie together
  std::uint32_t actions = 0;             ///< 0: a leaf
  std::uint32_t first_particle = 0, particles = 0;
  int depth = 0;
};

/// A belief node after one more action.
struct ActionNode {
  NodeBounds bounds;
  double reward = 0;  ///< of the step, discounted and weighted, less the pruning constant
  std::uint32_t parent = kNoNode;               ///< belief node
  std::uint32_t first_child = 0, children = 0;  ///< lie together, in order of observation
  int action = 0;
};

/// A regularised, anytime DESPOT (Ye, Somani, Hsu, Lee: "DESPOT: Online POMDP Planning with
/// Regularization", JAIR 2017): a tree of what K sampled scenarios may bring under every action,
/// searched from the top by where the root's uncertainty comes from. Pools are kept between
/// searches: once warm, a search doesn't allocate. Children lie in order of (observation,
/// scenario), and nothing depends on addresses or clocks, so the same scenarios give the same tree.
template <BeliefProblem Problem>
class BeliefTree {
 public:
  using State = typename Problem::State;

  /// The action to take at the root: the legal one with the largest lower bound, or the default
  /// policy's where that is worth more. Precondition: at least one scenario.
  SearchResult search(Problem& problem, const Scenarios<State>& scenarios,
                      const SearchParameters& parameters, const SearchBudget& budget) {
    start(problem, scenarios, parameters);
    while (run_trial(problem, budget)) {
    }
    return result();
  }

  /// A tree that is its root alone.
  void start(Problem& problem, const Scenarios<State>& scenarios,
             const SearchParameters& parameters);
  /// One way down from the root and what it teaches all nodes above. False where the search is
  /// over.
  bool run_trial(Problem& problem, const SearchBudget& budget);
  /// Gives a root that is a leaf its actions.
  void expand_root(Problem& problem) {
    if (beliefs_.front().actions == 0) expand(problem, 0), backup(0);
  }
  SearchResult result() const;

  /// Bounds on the root's value if it begins with this action; nothing but the root's upper bound
  /// is known of those that the root hasn't (lower: minus infinity).
  NodeBounds bounds_of(int action) const;
  int default_action() const { return default_action_; }

  /// Belief nodes, the root first, parents before children.
  std::span<const BeliefNode> beliefs() const { return beliefs_; }
  std::span<const ActionNode> action_nodes() const { return action_nodes_; }
  SearchStatistics statistics() const;

 private:
  ScenarioGroup<State> group_of(const BeliefNode& node) const {
    return {std::span(particles_).subspan(node.first_particle, node.particles), states_.data()};
  }
  std::span<ActionNode> actions_of(const BeliefNode& node) {
    return std::span(action_nodes_)
        .subspan(node.actions == 0 ? 0 : node.first_action, node.actions);
  }
  std::span<BeliefNode> children_of(const ActionNode& node) {
    return std::span(beliefs_).subspan(node.first_child, node.children);
  }
  std::uint32_t parent_of(std::uint32_t belief) const {
    const std::uint32_t action = beliefs_[belief].parent;
    return action == kNoNode ? kNoNode : action_nodes_[action].parent;
  }
  double draw(std::uint32_t scenario, int depth) const {
    return random_uniform(seed_, scenario, static_cast<std::uint64_t>(depth), Draw::Scenario);
  }

  std::uint32_t copy_state(std::uint32_t from);
  void add_belief(Problem& problem, std::uint32_t parent, std::uint32_t first, std::uint32_t end);
  void expand(Problem& problem, std::uint32_t belief);
  void expand_action(Problem& problem, std::uint32_t index);
  double default_value(Problem& problem, const BeliefNode& node);
  double roll_out(Problem& problem, std::uint32_t begin, std::uint32_t end, int depth);
  void exploit_blockers(std::uint32_t belief);
  std::uint32_t find_blocker(std::uint32_t belief) const;
  void close(BeliefNode& node);
  void update(BeliefNode& node);
  void update(ActionNode& node);
  void backup(std::uint32_t belief);
  double excess_uncertainty(const BeliefNode& node) const {
    return node.bounds.gap() - parameters_.gap_share * node.weight * beliefs_.front().bounds.gap();
  }
  std::uint32_t best_child(std::uint32_t belief);
  bool may_expand(const SearchBudget& budget);

  SearchParameters parameters_;
  SearchStatistics statistics_;
  std::uint64_t seed_ = 0;
  int default_action_ = 0;
  bool changed_ = false;           ///< by the present trial
  std::vector<double> discounts_;  ///< by depth
  std::vector<BeliefNode> beliefs_;
  std::vector<ActionNode> action_nodes_;
  std::vector<SearchParticle> particles_;
  std::vector<State> states_;  ///< the first states_used_ are in use
  std::uint32_t states_used_ = 0;
  std::vector<SearchParticle> rolling_;  ///< the default policy's scenarios
  std::vector<State> rolling_states_;
  std::vector<SearchParticle> scratch_;
};

/// Below this the root's bounds count as equal, as in the published solver.
inline constexpr double kClosedGap = 1e-6;

/// Puts particles that share an observation side by side, in order of (observation, scenario).
/// Precondition: they are in order of scenario. `scratch` holds at least as many.
inline void sort_by_observation(std::span<SearchParticle> particles,
                                std::vector<SearchParticle>& scratch) {
  constexpr std::size_t kFew = 16;
  std::array<std::uint64_t, kFew> seen{};
  std::size_t kinds = 0;
  for (const SearchParticle& particle : particles) {
    const auto end = seen.begin() + static_cast<std::ptrdiff_t>(kinds);
    if (std::find(seen.begin(), end, particle.observation) != end) continue;
    if (kinds == kFew) {
      std::sort(particles.begin(), particles.end(), [](const auto& a, const auto& b) {
        return a.observation != b.observation ? a.observation < b.observation
                                              : a.scenario < b.scenario;
      });
      return;
    }
    seen[kinds++] = particle.observation;
  }
  if (kinds < 2) return;
  std::sort(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(kinds));
  std::copy(particles.begin(), particles.end(), scratch.begin());
  auto to = particles.begin();
  for (std::size_t kind = 0; kind < kinds; ++kind)
    to = std::copy_if(scratch.begin(), scratch.begin() + std::ssize(particles), to,
                      [&](const auto& particle) { return particle.observation == seen[kind]; });
}

/// End of the run of particles with the observation of the one at `begin`.
inline std::uint32_t end_of_run(std::span<const SearchParticle> particles, std::uint32_t begin) {
  std::uint32_t end = begin + 1;
  while (end < particles.size() && particles[end].observation == particles[begin].observation)
    ++end;
  return end;
}

template <BeliefProblem Problem>
void BeliefTree<Problem>::start(Problem& problem, const Scenarios<State>& scenarios,
                                const SearchParameters& parameters) {
  const std::size_t count = scenarios.states.size();
  assert(count > 0 && scenarios.weights.size() == count && parameters.depth >= 1);
  parameters_ = parameters;
  statistics_ = {};
  seed_ = scenarios.seed;
  discounts_.resize(static_cast<std::size_t>(parameters.depth) + 1);
  double discount = 1;
  for (double& value : discounts_) value = discount, discount *= parameters.discount;
  beliefs_.clear();
  action_nodes_.clear();
  particles_.clear();
  states_used_ = 0;
  if (states_.size() < count) states_.resize(count, scenarios.states.front());
  if (rolling_states_.size() < count) rolling_states_.resize(count, scenarios.states.front());
  rolling_.reserve(count);
  scratch_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    states_[i] = scenarios.states[i];
    particles_.push_back(
        {scenarios.weights[i], scenarios.first + static_cast<std::uint32_t>(i), states_used_++, 0});
  }
  add_belief(problem, kNoNode, 0, states_used_);
  default_action_ = problem.default_action(group_of(beliefs_.front()));
}

/// A state of its own with the same value as another.
template <BeliefProblem Problem>
std::uint32_t BeliefTree<Problem>::copy_state(std::uint32_t from) {
  if (states_used_ == states_.size()) {
    State copy = states_[from];  // first, as the one copied moves where the pool grows
    states_.push_back(std::move(copy));
  } else {
    states_[states_used_] = states_[from];
  }
  return states_used_++;
}

/// A leaf with its bounds over particles [first, end).
template <BeliefProblem Problem>
void BeliefTree<Problem>::add_belief(Problem& problem, std::uint32_t parent, std::uint32_t first,
                                     std::uint32_t end) {
  BeliefNode node;
  node.parent = parent;
  node.first_particle = first;
  node.particles = end - first;
  node.depth = parent == kNoNode ? 0 : beliefs_[action_nodes_[parent].parent].depth + 1;
  const double discount = discounts_[static_cast<std::size_t>(node.depth)];
  double bound = 0;
  for (std::uint32_t i = first; i < end; ++i) {
    const SearchParticle& particle = particles_[i];
    node.weight += particle.weight;
    bound += particle.weight * problem.upper_bound(std::as_const(states_[particle.state]),
                                                   parameters_.depth - node.depth);
  }
  node.default_value = discount * default_value(problem, node);
  node.bounds.lower = node.default_value;
  node.bounds.utility = discount * bound;
  node.bounds.upper = node.bounds.utility - parameters_.pruning;
  if (node.bounds.upper < node.bounds.lower || node.depth >= parameters_.depth - 1)
    node.bounds.upper = node.bounds.lower;
  statistics_.deepest = std::max(statistics_.deepest, node.depth);
  beliefs_.push_back(node);
}

template <BeliefProblem Problem>
void BeliefTree<Problem>::expand(Problem& problem, std::uint32_t belief) {
  ++statistics_.expansions;
  changed_ = true;
  const std::uint32_t first = static_cast<std::uint32_t>(action_nodes_.size());
  for (const int action : std::span<const int>(problem.actions(group_of(beliefs_[belief]))))
    action_nodes_.push_back({.bounds = {}, .parent = belief, .action = action});
  const std::uint32_t end = static_cast<std::uint32_t>(action_nodes_.size());
  assert(end > first);
  for (std::uint32_t index = first; index < end; ++index) expand_action(problem, index);
  beliefs_[belief].first_action = first;
  beliefs_[belief].actions = end - first;
}

/// Steps every scenario of the belief above under the action, and makes a leaf of each observation.
template <BeliefProblem Problem>
void BeliefTree<Problem>::expand_action(Problem& problem, std::uint32_t index) {
  const BeliefNode parent = beliefs_[action_nodes_[index].parent];
  const int action = action_nodes_[index].action;
  const std::uint32_t begin = static_cast<std::uint32_t>(particles_.size());
  double reward = 0;
  for (std::uint32_t i = 0; i < parent.particles; ++i) {
    SearchParticle particle = particles_[parent.first_particle + i];
    particle.state = copy_state(particle.state);
    const StepOutcome outcome =
        problem.step(states_[particle.state], action, draw(particle.scenario, parent.depth));
    reward += particle.weight * outcome.reward;
    particle.observation = outcome.observation;
    if (outcome.ended) {
      --states_used_;
    } else {
      particles_.push_back(particle);
    }
  }
  statistics_.steps += parent.particles;
  const std::uint32_t end = static_cast<std::uint32_t>(particles_.size());
  sort_by_observation(std::span(particles_).subspan(begin), scratch_);
  const std::uint32_t first_child = static_cast<std::uint32_t>(beliefs_.size());
  for (std::uint32_t run = begin; run < end;) {
    const std::uint32_t run_end = end_of_run(particles_, run);
    add_belief(problem, index, run, run_end);
    run = run_end;
  }
  ActionNode& node = action_nodes_[index];
  node.first_child = first_child;
  node.children = static_cast<std::uint32_t>(beliefs_.size()) - first_child;
  node.reward = discounts_[static_cast<std::size_t>(parent.depth)] * reward - parameters_.pruning;
  NodeBounds& bounds = node.bounds;
  bounds = {node.reward, node.reward, node.reward + parameters_.pruning};
  for (const BeliefNode& child : children_of(node)) {
    bounds.lower += child.bounds.lower;
    bounds.upper += child.bounds.upper;
    bounds.utility += child.bounds.utility;
  }
}

/// Value of the default policy from a node to the search's end and beyond, weighted, undiscounted
/// to the node.
template <BeliefProblem Problem>
double BeliefTree<Problem>::default_value(Problem& problem, const BeliefNode& node) {
  if constexpr (KnowsDefaultValue<Problem>) {
    double value = 0;
    for (std::uint32_t i = 0; i < node.particles; ++i) {
      const SearchParticle& particle = particles_[node.first_particle + i];
      value += particle.weight * problem.default_value(std::as_const(states_[particle.state]));
    }
    return value;
  }
  rolling_.clear();
  for (std::uint32_t i = 0; i < node.particles; ++i) {
    SearchParticle particle = particles_[node.first_particle + i];
    rolling_states_[i] = states_[particle.state];
    particle.state = i;
    rolling_.push_back(particle);
  }
  return roll_out(problem, 0, node.particles, node.depth);
}

/// The same for rolling particles [begin, end), which share all observations; uses them up.
template <BeliefProblem Problem>
double BeliefTree<Problem>::roll_out(Problem& problem, std::uint32_t begin, std::uint32_t end,
                                     int depth) {
  double value = 0;
  if (depth >= parameters_.depth) {
    for (std::uint32_t i = begin; i < end; ++i)
      value += rolling_[i].weight *
               problem.value_at_end(std::as_const(rolling_states_[rolling_[i].state]));
    return value;
  }
  const std::span<SearchParticle> particles = std::span(rolling_).subspan(begin, end - begin);
  const int action =
      problem.default_action(ScenarioGroup<State>(particles, rolling_states_.data()));
  std::uint32_t kept = 0;
  for (SearchParticle particle : particles) {
    const StepOutcome outcome =
        problem.step(rolling_states_[particle.state], action, draw(particle.scenario, depth));
    value += particle.weight * outcome.reward;
    particle.observation = outcome.observation;
    if (!outcome.ended) particles[kept++] = particle;
  }
  statistics_.steps += end - begin;
  sort_by_observation(particles.first(kept), scratch_);
  double after = 0;
  for (std::uint32_t run = 0; run < kept;) {
    const std::uint32_t run_end = end_of_run(particles.first(kept), run);
    after += roll_out(problem, begin + run, begin + run_end, depth + 1);
    run = run_end;
  }
  return value + parameters_.discount * after;
}

template <BeliefProblem Problem>
bool BeliefTree<Problem>::may_expand(const SearchBudget& budget) {
  if (statistics_.expansions >= budget.expansions || statistics_.steps >= budget.steps)
    return false;
  statistics_.stopped = budget.stop && budget.stop();
  return !statistics_.stopped;
}

template <BeliefProblem Problem>
bool BeliefTree<Problem>::run_trial(Problem& problem, const SearchBudget& budget) {
  if (beliefs_.front().bounds.gap() <= kClosedGap) return false;
  ++statistics_.trials;
  changed_ = false;
  bool in_budget = true;
  std::uint32_t belief = 0;
  for (;;) {
    exploit_blockers(belief);
    if (beliefs_[belief].bounds.gap() <= 0) break;
    if (beliefs_[belief].actions == 0) {
      in_budget = may_expand(budget);
      if (!in_budget) break;
      expand(problem, belief);
    }
    const std::uint32_t next = best_child(belief);
    if (next == kNoNode) break;
    belief = next;
    if (excess_uncertainty(beliefs_[belief]) <= 0) break;
  }
  backup(belief);
  return in_budget && changed_;
}

/// Of the action with the largest upper bound the child with the largest excess uncertainty; none
/// where all its scenarios have ended.
template <BeliefProblem Problem>
std::uint32_t BeliefTree<Problem>::best_child(std::uint32_t belief) {
  const std::span<ActionNode> actions = actions_of(beliefs_[belief]);
  const ActionNode& action = *std::max_element(
      actions.begin(), actions.end(),
      [](const auto& a, const auto& b) { return a.bounds.upper < b.bounds.upper; });
  if (action.children == 0) return kNoNode;
  const std::span<BeliefNode> children = children_of(action);
  const auto best = std::max_element(
      children.begin(), children.end(),
      [&](const auto& a, const auto& b) { return excess_uncertainty(a) < excess_uncertainty(b); });
  return action.first_child + static_cast<std::uint32_t>(best - children.begin());
}

/// Where the way from an ancestor down to a node costs more in pruning constants than a perfect
/// plan could win over the ancestor's default policy, the node and its siblings get their default
/// value, and so does whatever that blocks further up.
template <BeliefProblem Problem>
void BeliefTree<Problem>::exploit_blockers(std::uint32_t belief) {
  if (parameters_.pruning <= 0) return;
  while (belief != kNoNode) {
    const std::uint32_t blocker = find_blocker(belief);
    if (blocker == kNoNode) return;
    if (blocker == belief) {
      close(beliefs_[belief]);
    } else {
      for (BeliefNode& node : children_of(action_nodes_[beliefs_[belief].parent])) close(node);
    }
    backup(belief);
    belief = parent_of(belief);
  }
}

template <BeliefProblem Problem>
std::uint32_t BeliefTree<Problem>::find_blocker(std::uint32_t belief) const {
  for (int count = 1; belief != kNoNode; ++count, belief = parent_of(belief)) {
    const BeliefNode& node = beliefs_[belief];
    if (node.bounds.utility - count * parameters_.pruning <= node.default_value) break;
  }
  return belief;
}

/// No more is looked for below: it keeps the best that it has, which is no less than its default
/// value.
template <BeliefProblem Problem>
void BeliefTree<Problem>::close(BeliefNode& node) {
  const double lower = node.bounds.lower;
  changed_ = node.bounds.tighten(lower, lower, lower) || changed_;
}

template <BeliefProblem Problem>
void BeliefTree<Problem>::update(BeliefNode& node) {
  if (node.actions == 0) return;
  double lower = node.default_value, upper = node.default_value;
  double utility = -std::numeric_limits<double>::infinity();
  for (const ActionNode& action : actions_of(node)) {
    lower = std::max(lower, action.bounds.lower);
    upper = std::max(upper, action.bounds.upper);
    utility = std::max(utility, action.bounds.utility);
  }
  changed_ = node.bounds.tighten(lower, upper, utility) || changed_;
}

template <BeliefProblem Problem>
void BeliefTree<Problem>::update(ActionNode& node) {
  double lower = node.reward, upper = node.reward, utility = node.reward + parameters_.pruning;
  for (const BeliefNode& child : children_of(node)) {
    lower += child.bounds.lower;
    upper += child.bounds.upper;
    utility += child.bounds.utility;
  }
  changed_ = node.bounds.tighten(lower, upper, utility) || changed_;
}

template <BeliefProblem Problem>
void BeliefTree<Problem>::backup(std::uint32_t belief) {
  for (;;) {
    update(beliefs_[belief]);
    const std::uint32_t action = beliefs_[belief].parent;
    if (action == kNoNode) return;
    update(action_nodes_[action]);
    belief = action_nodes_[action].parent;
  }
}

template <BeliefProblem Problem>
NodeBounds BeliefTree<Problem>::bounds_of(int action) const {
  const BeliefNode& root = beliefs_.front();
  NodeBounds bounds = root.bounds;
  bounds.lower = -std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < root.actions; ++i) {
    const ActionNode& node = action_nodes_[root.first_action + i];
    if (node.action == action) bounds = node.bounds;
  }
  if (action == default_action_) {
    bounds.lower = std::max(bounds.lower, root.default_value);
    bounds.upper = std::max(bounds.upper, bounds.lower);
  }
  return bounds;
}

template <BeliefProblem Problem>
SearchStatistics BeliefTree<Problem>::statistics() const {
  SearchStatistics statistics = statistics_;
  const NodeBounds& root = beliefs_.front().bounds;
  statistics.nodes = static_cast<std::int64_t>(beliefs_.size());
  statistics.lower = root.lower;
  statistics.upper = root.upper;
  statistics.closed = root.gap() <= kClosedGap;
  return statistics;
}

template <BeliefProblem Problem>
SearchResult BeliefTree<Problem>::result() const {
  SearchResult found{default_action_, statistics()};
  const BeliefNode& root = beliefs_.front();
  double best = -std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < root.actions; ++i) {
    const ActionNode& node = action_nodes_[root.first_action + i];
    if (node.bounds.lower <= best) continue;
    best = node.bounds.lower;
    found.action = node.action;
  }
  if (root.actions == 0 || root.default_value > best) {
    found.action = default_action_;
    found.statistics.by_default = true;
  }
  return found;
}

}  // namespace sumogamma
