#pragma once

#include <cstdint>
#include <functional>
#include <limits>

namespace sumogamma {

/// What a belief tree is searched with. The paper's planner and the public solver differ in K and D
/// alone: docs/planning.md has both sets.
struct SearchParameters {
  int depth = 90;           ///< D: steps from the root to the end of every scenario, at least 1
  double discount = 0.95;   ///< of what comes a step later
  double gap_share = 0.95;  ///< xi: of the root's gap, what a node's may keep, by its share of the
                            ///< scenarios
  double pruning = 0;       ///< lambda: what an action node has to be worth in the tree
};

/// When a search ends, whatever it has found: counted in what it does, so that the same search ends
/// with the same tree on any machine.
struct SearchBudget {
  std::int64_t expansions = std::numeric_limits<std::int64_t>::max();  ///< of nodes
  std::int64_t steps = std::numeric_limits<std::int64_t>::max();       ///< of one scenario each
  /// Asked before every expansion: true ends the search. Empty where nothing but the counts ends
  /// it; with a clock in it, a search can't be repeated.
  std::function<bool()> stop = {};
};

struct SearchStatistics {
  std::int64_t trials = 0, expansions = 0;
  std::int64_t nodes = 0;       ///< belief nodes, the root included
  std::int64_t steps = 0;       ///< of one scenario each, the default policy's included
  int deepest = 0;              ///< depth of the deepest node
  double lower = 0, upper = 0;  ///< bounds of the root, with regularisation
  bool closed = false;          ///< the root's gap is closed: more search would find nothing
  bool by_default = false;      ///< no action is better than the default policy's
  bool stopped = false;         ///< the budget's `stop` said so
};

struct SearchResult {
  int action = 0;
  SearchStatistics statistics;
};

}  // namespace sumogamma
