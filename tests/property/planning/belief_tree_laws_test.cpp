#include <gtest/gtest.h>

#include <vector>

#include "support/belief_episodes.h"

namespace sumogamma {
namespace {

using testing::BridgeWorld;
using testing::RockSample;
using testing::RockSampleWorld;
using testing::TagWorld;
using testing::Tiger;
using testing::TigerWorld;

constexpr double kRounding = 1e-9;

template <class Node>
void expect_tighter(const std::vector<Node>& before, std::span<const Node> now) {
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GE(now[i].bounds.lower, before[i].bounds.lower);
    EXPECT_LE(now[i].bounds.upper, before[i].bounds.upper);
    EXPECT_LE(now[i].bounds.utility, before[i].bounds.utility);
  }
  for (const Node& node : now) EXPECT_LE(node.bounds.lower, node.bounds.upper);
}

/// The laws of a tree, after every trial of a search.
template <class World>
void expect_laws(World world, double pruning, std::uint64_t seed) {
  SCOPED_TRACE(seed);
  using Problem = typename World::Problem;
  world.begin(random_uniform(seed, 1, 0, Draw::Intention));
  std::vector<typename Problem::State> states;
  testing::draw_scenarios(world, seed, 60, states);
  const std::vector<double> weights(60, 1.0 / 60);
  BeliefTree<Problem> tree;
  tree.start(world.problem, {states, weights, seed}, {.depth = 40, .pruning = pruning});
  std::vector<BeliefNode> beliefs(tree.beliefs().begin(), tree.beliefs().end());
  std::vector<ActionNode> actions;
  const SearchBudget budget{.expansions = 25};
  for (bool more = true; more;) {
    more = tree.run_trial(world.problem, budget);
    expect_tighter(beliefs, tree.beliefs());
    expect_tighter(actions, tree.action_nodes());
    beliefs.assign(tree.beliefs().begin(), tree.beliefs().end());
    actions.assign(tree.action_nodes().begin(), tree.action_nodes().end());
  }
  for (const ActionNode& node : actions) {
    double weight = 0;
    for (std::uint32_t i = 0; i < node.children; ++i) {
      const BeliefNode& child = beliefs[node.first_child + i];
      EXPECT_EQ(child.depth, beliefs[node.parent].depth + 1);
      weight += child.weight;
    }
    EXPECT_LE(weight, beliefs[node.parent].weight + kRounding);
  }
}

TEST(BeliefTreeLaws, BoundsOnlyTightenAndNeverCross) {
  const RockSample rocks = RockSample::of_size(4);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const double pruning = seed % 3 == 0 ? 0.0 : seed % 3 == 1 ? 0.01 : 0.3;
    expect_laws(TigerWorld{}, pruning, seed);
    expect_laws(BridgeWorld{}, pruning, seed);
    expect_laws(RockSampleWorld{.problem = rocks}, pruning, seed);
    if (seed <= 20) expect_laws(TagWorld{}, pruning, seed);
    if (HasFailure()) return;
  }
}

/// Tiger's exact value (V* at beliefs a number of hearings from the middle) and Bridge's are below
/// the upper bounds of every search of them and above the lower ones.
TEST(BeliefTreeLaws, BoundsHoldTheTrueValue) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    TigerWorld tiger;
    std::vector<int> states;
    testing::draw_scenarios(tiger, seed, 500, states);
    const std::vector<double> weights(500, 1.0 / 500);
    BeliefTree<Tiger> tree;
    const SearchResult found =
        tree.search(tiger.problem, {states, weights, seed}, {}, {.expansions = 100});
    EXPECT_GE(found.statistics.upper, 19.3714);
    BridgeWorld bridge;
    testing::draw_scenarios(bridge, seed, 500, states);
    BeliefTree<testing::Bridge> ways;
    const SearchResult over =
        ways.search(bridge.problem, {states, weights, seed}, {}, {.expansions = 100});
    const double value = (testing::cost_of(9) + testing::cost_of(8)) / 2;
    EXPECT_GE(over.statistics.upper, value - kRounding);
    EXPECT_LE(over.statistics.lower, value + kRounding);
  }
}

}  // namespace
}  // namespace sumogamma
