#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/parallel.h"
#include "planning/belief_tree.h"

namespace sumogamma {

/// Two trees, each over one half of the scenarios with half of the budget, and the action that is
/// best by both: for two threads without a lock, and with one thread the same bits. What it costs:
/// each tree plans by half of the scenarios, so that its lower bounds are more of hindsight.
template <BeliefProblem Problem>
class PairedSearch {
 public:
  using State = typename Problem::State;

  /// `problems`: one a tree, alike but for their scratch. Precondition: at least two scenarios. The
  /// statistics are sums over both trees, the bounds their means by weight; the search is closed
  /// where both are.
  SearchResult search(const std::array<Problem*, 2>& problems, const Scenarios<State>& scenarios,
                      const SearchParameters& parameters, const SearchBudget& budget,
                      Workers& workers);

  const BeliefTree<Problem>& tree(std::size_t half) const { return halves_[half].tree; }
  /// Both trees' BeliefTree::bounds_of, their means by weight.
  NodeBounds bounds_of(int action) const;

 private:
  struct Half {
    BeliefTree<Problem> tree;
    std::vector<double> weights;  ///< add up to 1
    double share = 0;             ///< of all scenarios' weight
  };

  static void take_half(const Scenarios<State>& all, std::size_t begin, std::size_t end, Half& half,
                        Scenarios<State>& part) {
    half.weights.assign(all.weights.begin() + static_cast<std::ptrdiff_t>(begin),
                        all.weights.begin() + static_cast<std::ptrdiff_t>(end));
    half.share = 0;
    for (const double weight : half.weights) half.share += weight;
    for (double& weight : half.weights) weight /= half.share;
    part = {all.states.subspan(begin, end - begin), half.weights, all.seed,
            all.first + static_cast<std::uint32_t>(begin)};
  }
  SearchResult joint_result() const;

  std::array<Half, 2> halves_;
};

template <BeliefProblem Problem>
SearchResult PairedSearch<Problem>::search(const std::array<Problem*, 2>& problems,
                                           const Scenarios<State>& scenarios,
                                           const SearchParameters& parameters,
                                           const SearchBudget& budget, Workers& workers) {
  const std::size_t count = scenarios.states.size(), middle = count / 2;
  assert(count >= 2);
  SearchBudget part = budget;
  part.expansions = std::max<std::int64_t>(budget.expansions / 2, 1);
  part.steps = std::max<std::int64_t>(budget.steps / 2, 1);
  const auto search_half = [&](std::size_t h) {
    Scenarios<State> own;
    take_half(scenarios, h == 0 ? 0 : middle, h == 0 ? middle : count, halves_[h], own);
    halves_[h].tree.search(*problems[h], own, parameters, part);
  };
  workers.for_each_range(2, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h) search_half(h);
  });
  // an action has to have a value in both trees to be compared
  const bool leaf[] = {tree(0).beliefs().front().actions == 0,
                       tree(1).beliefs().front().actions == 0};
  if (leaf[0] != leaf[1] || tree(0).default_action() != tree(1).default_action())
    for (std::size_t h = 0; h < 2; ++h) halves_[h].tree.expand_root(*problems[h]);
  return joint_result();
}

template <BeliefProblem Problem>
NodeBounds PairedSearch<Problem>::bounds_of(int action) const {
  const NodeBounds first = tree(0).bounds_of(action), second = tree(1).bounds_of(action);
  const auto mean = [&](double NodeBounds::*bound) {
    return halves_[0].share * first.*bound + halves_[1].share * second.*bound;
  };
  return {mean(&NodeBounds::lower), mean(&NodeBounds::upper), mean(&NodeBounds::utility)};
}

template <BeliefProblem Problem>
SearchResult PairedSearch<Problem>::joint_result() const {
  SearchResult found = halves_[0].tree.result();
  const SearchResult other = halves_[1].tree.result();
  SearchStatistics& sum = found.statistics;
  const SearchStatistics& more = other.statistics;
  sum.trials += more.trials;
  sum.expansions += more.expansions;
  sum.nodes += more.nodes;
  sum.steps += more.steps;
  sum.deepest = std::max(sum.deepest, more.deepest);
  sum.lower = halves_[0].share * sum.lower + halves_[1].share * more.lower;
  sum.upper = halves_[0].share * sum.upper + halves_[1].share * more.upper;
  sum.closed = sum.closed && more.closed;
  sum.stopped = sum.stopped || more.stopped;
  if (found.action == other.action) {
    sum.by_default = sum.by_default && more.by_default;
    return found;
  }
  const BeliefNode& root = tree(0).beliefs().front();
  double best = bounds_of(found.action).lower;
  for (std::uint32_t i = 0; i < root.actions; ++i) {
    const int action = tree(0).action_nodes()[root.first_action + i].action;
    const double value = bounds_of(action).lower;
    if (value <= best) continue;
    best = value;
    found.action = action;
  }
  sum.by_default = false;
  return found;
}

}  // namespace sumogamma
