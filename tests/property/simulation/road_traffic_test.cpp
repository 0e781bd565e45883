// Frozen generation on roads: whatever a row decides it decides from the state that all others see,
// too.
#include "support/road_traffic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "traffic/recovery/reversing.h"

namespace sumogamma {
namespace {

using testing::kAgents;
using testing::RoadTraffic;

// a rule or two of the road each: right of way, gaps, signals and filtering, changes of lane,
// people
const char* const kNetworks[] = {"all_way_stop", "roundabout", "mixed_queue",
                                 "lane_drop",    "zebra",      "two_way_stop"};
constexpr int kTicks = 1000;

/// Hash of all states of a run.
std::uint64_t run_hash(RoadTraffic& traffic) {
  std::uint64_t hash = kFnvBasis;
  for (int k = 0; k < kTicks; ++k) {
    traffic.step();
    hash = hash_state(traffic.sim.scene, hash);
  }
  return hash;
}

TEST(RoadTraffic, GivesTheSameBitsForAnyNumberOfThreads) {
  for (const std::string name : kNetworks) {
    SCOPED_TRACE(name);
    RoadTraffic one(name, 1, kAgents, 1);
    const std::uint64_t hash = run_hash(one);
    EXPECT_GE(one.arrived(), 10u) << "too little goes on";
    for (const std::size_t threads : {3u, 7u}) {
      RoadTraffic many(name, 1, kAgents, threads);
      EXPECT_EQ(run_hash(many), hash) << threads;
    }
  }
}

// who backs out next follows from everybody's state of the last tick, in whatever order rows are
// looked at
TEST(RoadTraffic, WhoBacksOutDoesNotDependOnTheOrderOfRows) {
  Workers one(1), many(7);
  int backing = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    RoadTraffic traffic("two_way_stop", seed, kAgents, 1);
    for (int k = 0; k < 3 * kTicks; ++k) {
      traffic.step();
      Simulation& sim = traffic.sim;
      std::vector<Backing> next;
      const auto after = [&](Workers& workers) {
        TrafficState state = sim.traffic.state;
        const TrafficView view{sim.model,
                               sim.road,
                               sim.scene,
                               state,
                               sim.work.geometry.grid,
                               sim.traffic.approaches,
                               sim.traffic.perception,
                               sim.traffic.waits,
                               sim.traffic.parameters,
                               sim.traffic.code};
        update_backing(view, sim.work.geometry, sim.dt, workers, next, state);
        return std::pair{state.backing_left, state.gives_way_left};
      };
      const auto together = after(one);
      EXPECT_EQ(after(many), together) << "tick " << sim.scene.tick;
      backing += std::any_of(together.first.begin(), together.first.end(),
                             [](double left) { return left > 0.0; });
    }
  }
  EXPECT_GT(backing, 0) << "nobody backs out";
}

}  // namespace
}  // namespace sumogamma
