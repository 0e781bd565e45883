// Frozen generation on roads: whatever a row decides it decides from the state that all others see,
// too.
#include "support/road_traffic.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace sumogamma {
namespace {

using testing::RoadTraffic;

// a rule or two of the road each: right of way, gaps, signals and filtering, changes of lane,
// people
const char* const kNetworks[] = {"all_way_stop", "roundabout", "mixed_queue",
                                 "lane_drop",    "zebra",      "two_way_stop"};
constexpr std::size_t kAgents = 40;
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

}  // namespace
}  // namespace sumogamma
