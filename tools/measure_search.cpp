// The belief tree search against the problems of its literature: the table of docs/planning.md.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "support/belief_episodes.h"

namespace sumogamma::testing {
namespace {

struct Trial {
  const char* name;
  int runs;
  std::function<double(std::uint64_t seed, std::int64_t expansions)> run;
};

template <class World>
Trial trial(const char* name, int runs, const World& world, double pruning = 0) {
  return {name, runs, [world, pruning](std::uint64_t seed, std::int64_t expansions) {
            EpisodeOptions options;
            options.search.pruning = pruning;
            options.budget.expansions = expansions;
            World own = world;
            thread_local BeliefTree<typename World::Problem> tree;
            return run_episode(own, tree, options, seed);
          }};
}

std::vector<Trial> trials() {
  return {trial("bridge", 10, BridgeWorld{}),
          trial("rocksample-4-4", 200, RockSampleWorld{.problem = RockSample::of_size(4)}),
          trial("rocksample-7-8", 200, RockSampleWorld{.problem = RockSample::of_size(7)}),
          trial("rocksample-11-11", 100, RockSampleWorld{.problem = RockSample::of_size(11)}),
          trial("tag", 300, TagWorld{}, 0.01),
          trial("tiger", 1000, TigerWorld{})};
}

void measure(const Trial& trial, int runs, std::int64_t expansions, Workers& workers) {
  std::vector<double> returns(static_cast<std::size_t>(runs));
  const auto begin = std::chrono::steady_clock::now();
  workers.for_each_range(returns.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) returns[i] = trial.run(i + 1, expansions);
  });
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  double mean = 0, square = 0;
  for (const double value : returns) mean += value / runs;
  for (const double value : returns) square += (value - mean) * (value - mean);
  const double deviation = runs > 1 ? std::sqrt(square / (runs - 1)) : 0;
  std::printf(
      "%-17s %5d runs  mean %8.3f  95%% +- %6.3f  SD %6.2f  least %8.2f  most %7.2f  %6.1f s\n",
      trial.name, runs, mean, 1.96 * deviation / std::sqrt(runs), deviation,
      *std::min_element(returns.begin(), returns.end()),
      *std::max_element(returns.begin(), returns.end()), took.count());
  std::fflush(stdout);
}

/// A whole number of at least 1; 0 where the text is none.
int number(const char* text) {
  int value = 0;
  const char* end = text + std::strlen(text);
  return std::from_chars(text, end, value).ptr == end && value >= 1 ? value : 0;
}

int run(const std::vector<std::string>& arguments) {
  std::string only;
  int runs = 0, expansions = 100, threads = 1;
  for (std::size_t i = 0; i < arguments.size(); i += 2) {
    const bool has_value = i + 1 < arguments.size();
    int* option = arguments[i] == "--runs"         ? &runs
                  : arguments[i] == "--expansions" ? &expansions
                  : arguments[i] == "--threads"    ? &threads
                                                   : nullptr;
    if (has_value && arguments[i] == "--problem") {
      only = arguments[i + 1];
    } else if (!has_value || option == nullptr ||
               (*option = number(arguments[i + 1].c_str())) == 0) {
      std::fprintf(stderr,
                   "measure_search: %s: usage: [--problem NAME] [--runs N] [--expansions N] "
                   "[--threads N]\n",
                   arguments[i].c_str());
      return 2;
    }
  }
  Workers workers(static_cast<std::size_t>(threads));
  bool found = false;
  for (const Trial& trial : trials()) {
    if (!only.empty() && only != trial.name) continue;
    found = true;
    measure(trial, runs > 0 ? runs : trial.runs, expansions, workers);
  }
  if (!found) std::fprintf(stderr, "measure_search: %s: no such problem\n", only.c_str());
  return found ? 0 : 2;
}

}  // namespace
}  // namespace sumogamma::testing

int main(int count, char** values) {
  return sumogamma::testing::run(std::vector<std::string>(values + 1, values + count));
}
