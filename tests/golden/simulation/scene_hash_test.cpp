#include <gtest/gtest.h>

#include "simulation/scene_run.h"
#include "support/made_scenes.h"
#include "support/recorded_bits.h"

namespace sumogamma {
namespace {

// The exact bits of short runs, the same for every number of threads, with g++ and clang++. They
// change when the model does: then look at docs/model.md's tables again and put the new ones in.
TEST(GoldenScenes, HaveTheRecordedBits) {
  if (!test::computes_as_recorded()) GTEST_SKIP() << test::kOtherLibrary;
  Workers workers(3);
  const auto hash = [&](const SceneFile& file, std::size_t steps) {
    return run_scene(file, ModelOptions{}, steps, 0.05, workers).state_hash;
  };
  EXPECT_EQ(hash(test::mixed_scene(7, 120, 28), 100), 16739590888782406800ULL);
  EXPECT_EQ(hash(test::ring_scene("Car", 8, 24, 4), 200), 17511003987632234927ULL);
}

}  // namespace
}  // namespace sumogamma
