#include <gtest/gtest.h>

#include "support/belief_episodes.h"

namespace sumogamma {
namespace {

using testing::EpisodeOptions;
using testing::RockSample;
using testing::RockSampleWorld;
using testing::TagWorld;
using testing::TigerWorld;

// A short form of the table that tools/measure_search.cpp makes (docs/planning.md), with bounds
// that a search which does no more than its default policy, or a greedy one, falls short of.
template <class World>
double mean_return(const World& world, int runs, const EpisodeOptions& options) {
  BeliefTree<typename World::Problem> tree;
  double sum = 0;
  for (int run = 0; run < runs; ++run) {
    World own = world;
    sum += testing::run_episode(own, tree, options, static_cast<std::uint64_t>(run + 1));
  }
  return sum / runs;
}

TEST(SearchProblems, RockSampleIsWorthMoreThanGoingToTheExit) {
  EpisodeOptions options;
  options.scenarios = 100;
  options.budget.expansions = 40;
  const RockSampleWorld small{.problem = RockSample::of_size(4)};
  const double found = mean_return(small, 20, options);
  EXPECT_GE(found, 16.0);  // the exit alone: 8.6
  const RockSampleWorld large{.problem = RockSample::of_size(7)};
  options.budget.expansions = 25;
  const double more = mean_return(large, 4, options);
  EXPECT_GE(more, 16.5);  // the exit alone: 7.35
  EXPECT_LE(more, 25.2);
}

TEST(SearchProblems, TigersDoorsAreOpenedForMoreThanListeningIsWorth) {
  EpisodeOptions options;
  options.scenarios = 100;
  EXPECT_GE(mean_return(TigerWorld{}, 15, options), 6.0);  // listening alone: -20
}

TEST(SearchProblems, TagIsCaught) {
  EpisodeOptions options;
  options.scenarios = 60;
  options.budget.expansions = 25;
  options.search.pruning = 0.01;
  EXPECT_GE(mean_return(TagWorld{}, 8, options), -11.0);  // walking about for ever: -19.8
}

}  // namespace
}  // namespace sumogamma
