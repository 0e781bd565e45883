#pragma once

// Whole episodes of the problems of belief_problems.h: search, act, learn, until the end.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "base/random.h"
#include "planning/belief_tree.h"
#include "planning/comb_sampling.h"
#include "support/belief_problems.h"

namespace sumogamma::testing {

/// A problem, what is true in it and what is known of that. Beliefs are exact.
struct TigerWorld {
  using Problem = Tiger;
  Tiger problem;
  Tiger::State truth = 0;
  double right = 0.5;  ///< probability of the tiger behind the right door

  void begin(double draw) { truth = draw < 0.5 ? 0 : 1, right = 0.5; }
  void list(std::vector<Tiger::State>& states, std::vector<double>& weights) const {
    states = {0, 1};
    weights = {1 - right, right};
  }
  void learn(int action, std::uint64_t observation) {
    const double heard = observation == 1 ? Tiger::kRight : 1 - Tiger::kRight;
    right =
        action == Tiger::Listen ? right * heard / (right * heard + (1 - right) * (1 - heard)) : 0.5;
  }
};

struct BridgeWorld {
  using Problem = Bridge;
  Bridge problem;
  Bridge::State truth = 0;
  std::vector<double> at = {0.5, 0.5};  ///< by cell, those up to the last possible one

  void begin(double) { truth = 0, at = {0.5, 0.5}; }
  void list(std::vector<Bridge::State>& states, std::vector<double>& weights) const {
    states.resize(at.size());
    std::iota(states.begin(), states.end(), 0);
    weights = at;
  }
  void learn(int action, std::uint64_t) {
    std::vector<double> next(Bridge::kLast + 1, 0.0);
    for (int cell = 0; cell < static_cast<int>(at.size()); ++cell) {
      Bridge::State state = cell;
      if (!problem.step(state, action, 0).ended)
        next[static_cast<std::size_t>(state)] += at[static_cast<std::size_t>(cell)];
    }
    at = next;
  }
};

struct RockSampleWorld {
  using Problem = RockSample;
  RockSample problem;
  RockSample::State truth{};
  std::vector<double> good{};  ///< by rock

  void begin(double draw) {
    truth = problem.start();
    truth.good = static_cast<std::uint32_t>(draw * (1u << problem.rocks()));
    good.assign(static_cast<std::size_t>(problem.rocks()), 0.5);
  }
  void list(std::vector<RockSample::State>& states, std::vector<double>& weights) const {
    states.clear();
    weights.clear();
    RockSample::State state = truth;  // where the robot is, is known
    for (state.good = 0; state.good < 1u << problem.rocks(); ++state.good) {
      double weight = 1;
      for (std::size_t rock = 0; rock < good.size(); ++rock)
        weight *= (state.good >> rock & 1) != 0 ? good[rock] : 1 - good[rock];
      states.push_back(state);
      weights.push_back(weight);
    }
  }
  void learn(int action, std::uint64_t observation) {
    if (action >= RockSample::Check) {
      const int rock = action - RockSample::Check;
      const double right = problem.certainty(truth, rock);
      const double seen = observation == 2 ? right : 1 - right;
      double& p = good[static_cast<std::size_t>(rock)];
      p = p * seen / (p * seen + (1 - p) * (1 - seen));
    } else if (action == RockSample::Sample) {
      good[static_cast<std::size_t>(problem.rock_at(truth))] = 0;
    }
  }
};

struct TagWorld {
  using Problem = Tag;
  Tag problem;
  Tag::State truth{};
  std::vector<double> at{};  ///< by index of the state

  static Tag::State state_of(std::size_t index) {
    return {static_cast<std::int8_t>(index / Tag::kCells),
            static_cast<std::int8_t>(index % Tag::kCells)};
  }
  void begin(double draw) {
    truth = state_of(static_cast<std::size_t>(draw * Tag::kCells * Tag::kCells));
    at.assign(Tag::kCells * Tag::kCells, 1.0);
  }
  void list(std::vector<Tag::State>& states, std::vector<double>& weights) const {
    states.clear();
    weights.clear();
    for (std::size_t index = 0; index < at.size(); ++index) {
      if (at[index] <= 0) continue;
      states.push_back(state_of(index));
      weights.push_back(at[index]);
    }
  }
  void learn(int action, std::uint64_t observation) {
    std::vector<double> next(at.size(), 0.0);
    double sum = 0;
    for (std::size_t index = 0; index < at.size(); ++index) {
      const Tag::State before = state_of(index);
      if (at[index] <= 0 || (action == Tag::Catch && before.robot == before.target)) continue;
      for (const auto& [cell, probability] : problem.flights(before.robot, before.target)) {
        Tag::State after = before;
        if (action != Tag::Catch)
          after.robot = static_cast<std::int8_t>(problem.neighbour(before.robot, action));
        after.target = static_cast<std::int8_t>(cell);
        if (Tag::observation(after) != observation) continue;
        next[Tag::index(after)] += at[index] * probability;
        sum += at[index] * probability;
      }
    }
    for (double& weight : next) weight /= sum;
    at = next;
  }
};

struct EpisodeOptions {
  std::size_t scenarios = 500;  ///< K
  SearchParameters search;
  SearchBudget budget{.expansions = 100};
  int most_steps = 90;
};

/// K scenarios of what is known in a world, in an order of chance: the comb would else choose by
/// how states happen to be numbered.
template <class World>
void draw_scenarios(const World& world, std::uint64_t seed, std::size_t count,
                    std::vector<typename World::Problem::State>& drawn) {
  std::vector<typename World::Problem::State> states;
  std::vector<double> weights, mixed;
  world.list(states, weights);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < states.size(); ++i)
    order.push_back({random_bits(seed, i, 1, Draw::Scenario), i});
  std::sort(order.begin(), order.end());
  for (const auto& [key, i] : order) mixed.push_back(weights[i]);
  std::vector<std::uint32_t> chosen(count);
  comb_sample(mixed, random_uniform(seed, 0, 2, Draw::Scenario), chosen);
  drawn.clear();
  for (const std::uint32_t i : chosen) drawn.push_back(states[order[i].second]);
}

/// Discounted return of one episode; a pure function of its arguments. `first_actions`: filled with
/// the actions taken, where it isn't null.
template <class World>
double run_episode(World& world, BeliefTree<typename World::Problem>& tree,
                   const EpisodeOptions& options, std::uint64_t seed,
                   std::vector<int>* actions = nullptr) {
  std::vector<typename World::Problem::State> drawn;
  const std::vector<double> weights(options.scenarios,
                                    1.0 / static_cast<double>(options.scenarios));
  double sum = 0, discount = 1;
  world.begin(random_uniform(seed, 0, 0, Draw::Intention));
  for (std::uint64_t step = 0; step < static_cast<std::uint64_t>(options.most_steps); ++step) {
    const std::uint64_t search_seed = random_bits(seed, 1, step, Draw::Scenario);
    draw_scenarios(world, search_seed, options.scenarios, drawn);
    const int action =
        tree.search(world.problem, {drawn, weights, search_seed}, options.search, options.budget)
            .action;
    const StepOutcome outcome =
        world.problem.step(world.truth, action, random_uniform(seed, 0, step, Draw::ProcessNoise));
    if (actions != nullptr) actions->push_back(action);
    sum += discount * outcome.reward;
    discount *= options.search.discount;
    if (outcome.ended) break;
    world.learn(action, outcome.observation);
  }
  return sum;
}

}  // namespace sumogamma::testing
