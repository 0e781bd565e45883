#include "planning/belief_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "planning/paired_search.h"
#include "support/belief_episodes.h"
#include "unit/planning/counted_heap.h"

namespace sumogamma {
namespace {

using testing::Bridge;
using testing::BridgeWorld;
using testing::EpisodeOptions;
using testing::RockSample;
using testing::RockSampleWorld;
using testing::Tag;
using testing::TagWorld;
using testing::Tiger;
using testing::TigerWorld;

/// What a search of a world's first belief works on.
template <class World>
struct Root {
  std::vector<typename World::Problem::State> states;
  std::vector<double> weights;

  Root(const World& world, std::size_t count, std::uint64_t seed = 1)
      : weights(count, 1.0 / static_cast<double>(count)) {
    testing::draw_scenarios(world, seed, count, states);
  }
  Scenarios<typename World::Problem::State> scenarios() const { return {states, weights, 7}; }
};

template <class World>
World begun(World world) {
  world.begin(0.3);
  return world;
}

SearchResult search_tiger(double right) {
  Tiger problem;
  BeliefTree<Tiger> tree;
  const std::vector<int> states = {0, 1};
  std::vector<int> drawn;
  const std::vector<double> belief = {1 - right, right}, weights(500, 1.0 / 500);
  std::vector<std::uint32_t> chosen(500);
  comb_sample(belief, 0.5, chosen);
  for (const std::uint32_t i : chosen) drawn.push_back(states[i]);
  return tree.search(problem, {drawn, weights, 3}, {}, {.expansions = 200});
}

TEST(BeliefTree, OpensTheOtherDoorOnceItIsSureOfTheTiger) {
  EXPECT_EQ(search_tiger(0.5).action, Tiger::Listen);
  EXPECT_EQ(search_tiger(0.85).action, Tiger::Listen);
  EXPECT_EQ(search_tiger(0.9698).action, Tiger::OpenLeft);
  EXPECT_EQ(search_tiger(1 - 0.9698).action, Tiger::OpenRight);
}

TEST(BeliefTree, GoesOverTheBridgeToItsEnd) {
  BridgeWorld world;
  BeliefTree<Bridge> tree;
  std::vector<int> actions;
  const double value = testing::run_episode(world, tree, {}, 1, &actions);
  EXPECT_EQ(actions, std::vector<int>(10, Bridge::Right));
  EXPECT_NEAR(value, -(1 - std::pow(0.95, 9)) / 0.05, 1e-12);
  // of a search too shallow to see the end only the way back to help is left
  EpisodeOptions shallow;
  shallow.search.depth = 4;
  EXPECT_LT(testing::run_episode(world, tree, shallow, 1), -19);
}

TEST(BeliefTree, WithNoBudgetDoesAsTheDefaultPolicy) {
  Tiger problem;
  BeliefTree<Tiger> tree;
  const Root<TigerWorld> root({}, 50);
  const SearchResult found = tree.search(problem, root.scenarios(), {}, {.expansions = 0});
  EXPECT_EQ(found.action, Tiger::Listen);
  EXPECT_TRUE(found.statistics.by_default);
  EXPECT_EQ(found.statistics.nodes, 1);
}

TEST(BeliefTree, StopsWhereItIsTold) {
  const RockSampleWorld world = begun(RockSampleWorld{.problem = RockSample::of_size(7)});
  RockSample problem = world.problem;
  BeliefTree<RockSample> tree;
  const Root<RockSampleWorld> root(world, 100);
  int asked = 0;
  const SearchResult found =
      tree.search(problem, root.scenarios(), {}, {.stop = [&] { return ++asked > 5; }});
  EXPECT_TRUE(found.statistics.stopped);
  EXPECT_EQ(found.statistics.expansions, 5);
  const SearchResult counted = tree.search(problem, root.scenarios(), {}, {.steps = 20000});
  EXPECT_FALSE(counted.statistics.stopped);
  EXPECT_GE(counted.statistics.steps, 20000);
  // no more than what one node's expansion takes: every action for every scenario
  EXPECT_LT(counted.statistics.steps, 20000 + 13 * 100);
}

TEST(BeliefTree, DoesAsTheDefaultPolicyWhereActionsCostMoreThanTheyBring) {
  const RockSampleWorld world = begun(RockSampleWorld{.problem = RockSample::of_size(7)});
  RockSample problem = world.problem;
  BeliefTree<RockSample> tree;
  const Root<RockSampleWorld> root(world, 100);
  SearchParameters parameters;
  EXPECT_NE(tree.search(problem, root.scenarios(), parameters, {.expansions = 50}).action,
            RockSample::East);
  parameters.pruning = 1e6;
  const SearchResult found = tree.search(problem, root.scenarios(), parameters, {.expansions = 50});
  EXPECT_EQ(found.action, RockSample::East);
  EXPECT_TRUE(found.statistics.by_default);
  EXPECT_TRUE(found.statistics.closed);
}

/// Nothing happens: whatever one does, bounds are equal from the start.
struct Nothing {
  using State = int;
  std::array<int, 2> both = {3, 5};
  StepOutcome step(State&, int, double) const { return {}; }
  std::span<const int> actions(const ScenarioGroup<State>&) const { return both; }
  int default_action(const ScenarioGroup<State>&) const { return 5; }
  double value_at_end(const State&) const { return 0; }
  double upper_bound(const State&, int) const { return 0; }
};

TEST(BeliefTree, HasAnActionWhereTheBoundsAreEqualAtTheRoot) {
  Nothing problem;
  BeliefTree<Nothing> tree;
  const std::vector<int> states = {0};
  const std::vector<double> weights = {1};
  const SearchResult found = tree.search(problem, {states, weights, 1}, {}, {.expansions = 9});
  EXPECT_EQ(found.action, 5);
  EXPECT_TRUE(found.statistics.closed);
  EXPECT_EQ(found.statistics.expansions, 0);
}

/// Two ways that end at once, of which the second isn't legal where the state says so.
struct Gate {
  using State = int;  ///< 1: shut
  std::array<int, 2> both = {0, 1};
  StepOutcome step(State&, int action, double) const { return {action == 1 ? 9.0 : 1.0, 0, true}; }
  std::span<const int> actions(const ScenarioGroup<State>& group) const {
    return std::span<const int>(both).first(group.state(0) == 1 ? 1 : 2);
  }
  int default_action(const ScenarioGroup<State>&) const { return 0; }
  double value_at_end(const State&) const { return 0; }
  double upper_bound(const State&, int) const { return 10; }
};

TEST(BeliefTree, TakesLegalActionsOnly) {
  Gate problem;
  BeliefTree<Gate> tree;
  const std::vector<double> weights = {1};
  const std::array<int, 1> open = {0}, shut = {1};
  EXPECT_EQ(tree.search(problem, {open, weights, 1}, {}, {.expansions = 9}).action, 1);
  EXPECT_EQ(tree.search(problem, {shut, weights, 1}, {}, {.expansions = 9}).action, 0);
}

TEST(BeliefTree, WeighsScenarios) {
  Tiger problem;
  BeliefTree<Tiger> tree;
  const std::vector<int> states = {0, 1};
  const std::vector<double> sure = {0.97, 0.03}, unsure = {0.5, 0.5};
  const SearchParameters shallow{.depth = 2};
  EXPECT_EQ(tree.search(problem, {states, sure, 1}, shallow, {.expansions = 9}).action,
            Tiger::OpenRight);
  EXPECT_EQ(tree.search(problem, {states, unsure, 1}, shallow, {.expansions = 9}).action,
            Tiger::Listen);
}

TEST(BeliefTree, TakesNothingFromTheHeapOnceWarm) {
  const TagWorld world = begun(TagWorld{});
  Tag problem;
  BeliefTree<Tag> tree;
  const Root<TagWorld> root(world, 100), other(world, 100, 2);
  const SearchParameters parameters{.pruning = 0.01};
  const SearchBudget budget{.expansions = 30};
  for (const auto* one : {&root, &other})
    tree.search(problem, one->scenarios(), parameters, budget);
  const std::size_t before = testing::heap_allocations();
  tree.search(problem, root.scenarios(), parameters, budget);
  tree.search(problem, other.scenarios(), parameters, budget);
  EXPECT_EQ(testing::heap_allocations(), before);
  BeliefTree<Tag> cold;
  cold.search(problem, root.scenarios(), parameters, budget);
  EXPECT_GT(testing::heap_allocations(), before);
}

TEST(PairedSearch, HasTheSameBitsWithOneAndTwoThreads) {
  const RockSampleWorld world = begun(RockSampleWorld{.problem = RockSample::of_size(7)});
  RockSample first = world.problem, second = world.problem;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Root<RockSampleWorld> root(world, 101, seed);
    std::array<SearchResult, 2> found;
    for (std::size_t threads = 1; threads <= 2; ++threads) {
      Workers workers(threads);
      PairedSearch<RockSample> search;
      found[threads - 1] =
          search.search({&first, &second}, root.scenarios(), {}, {.expansions = 60}, workers);
    }
    EXPECT_EQ(found[0].action, found[1].action);
    EXPECT_EQ(found[0].statistics.nodes, found[1].statistics.nodes);
    EXPECT_EQ(found[0].statistics.lower, found[1].statistics.lower);
    EXPECT_EQ(found[0].statistics.upper, found[1].statistics.upper);
    EXPECT_EQ(found[0].statistics.expansions, 60);
  }
}

TEST(PairedSearch, DecidesByBothTrees) {
  Tiger first, second;
  Workers workers(1);
  PairedSearch<Tiger> search;
  // half of them would open the left door by themselves, the other half the right one
  std::vector<int> states(20, 0);
  std::fill(states.begin() + 10, states.end(), 1);
  const std::vector<double> weights(20, 0.05);
  const auto found =
      search.search({&first, &second}, {states, weights, 1}, {}, {.expansions = 40}, workers);
  EXPECT_EQ(search.tree(0).result().action, Tiger::OpenRight);
  EXPECT_EQ(search.tree(1).result().action, Tiger::OpenLeft);
  EXPECT_EQ(found.action, Tiger::Listen);
}

TEST(CombSampling, ChoosesByShare) {
  const std::vector<double> weights = {0, 3, 1, 0, 4, 0};
  std::vector<std::uint32_t> chosen(8);
  for (const double draw : {0.0, 0.5, 0.999999}) {
    comb_sample(weights, draw, chosen);
    EXPECT_EQ(chosen, (std::vector<std::uint32_t>{1, 1, 1, 2, 4, 4, 4, 4}));
  }
  std::vector<std::uint32_t> one(1);
  comb_sample(weights, 0.999999999999, one);
  EXPECT_EQ(one[0], 4u);
}

TEST(BeliefProblems, KnowTheValuesOfTheirLiterature) {
  const RockSample rocks = RockSample::of_size(7);
  EXPECT_NEAR(rocks.default_value(rocks.start()), 10 * std::pow(0.95, 6), 1e-12);  // 7.35
  // who knows all rocks gets more than anybody can who has to check them: at most 25.2
  double mean = 0;
  RockSample::State state = rocks.start();
  for (state.good = 0; state.good < 256; ++state.good) mean += rocks.upper_bound(state, 90) / 256;
  EXPECT_GT(mean, 25.2);
  const Tag hall;
  for (int cell = 0; cell < Tag::kCells; ++cell)
    for (int robot = 0; robot < Tag::kCells; ++robot) {
      double sum = 0;
      for (const auto& [there, probability] : hall.flights(robot, cell)) sum += probability;
      EXPECT_NEAR(sum, 1, 1e-12);
    }
}

}  // namespace
}  // namespace sumogamma
