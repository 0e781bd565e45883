#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "simulation/simulation.h"

namespace sumogamma {
namespace {

/// A world without anybody that says where it made its steps.
class EmptyWorld final : public World {
 public:
  void observe(Scene&, RoadState&) override {}
  void advance(const Scene&) override {
    ++steps;
    thread = std::this_thread::get_id();
    if (fails) throw std::runtime_error("went away");
  }
  bool finished() const override { return false; }

  int steps = 0;
  bool fails = false;
  std::thread::id thread;
};

TEST(Record, IsCalledOnceATickWithTheNewState) {
  for (const std::size_t workers : {1u, 2u, 3u}) {
    Simulation sim;
    sim.workers = std::make_unique<Workers>(workers);
    EmptyWorld world;
    std::vector<std::int64_t> seen;
    for (int k = 0; k < 50; ++k) tick(sim, world, [&] { seen.push_back(sim.scene.tick); });
    tick(sim, world);
    ASSERT_EQ(seen.size(), 50u);
    for (int k = 0; k < 50; ++k) EXPECT_EQ(seen[static_cast<std::size_t>(k)], k + 1);
    EXPECT_EQ(world.steps, 51);
    EXPECT_EQ(world.thread, std::this_thread::get_id());
  }
}

TEST(Record, IsCompleteWhereTheWorldFails) {
  Simulation sim;
  sim.workers = std::make_unique<Workers>(2);
  EmptyWorld world;
  world.fails = true;
  int recorded = 0;
  EXPECT_THROW(tick(sim, world, [&] { ++recorded; }), std::runtime_error);
  EXPECT_EQ(recorded, 1);
  EXPECT_THROW(tick(sim, world, [&] { throw std::logic_error("ours"); }), std::runtime_error);
  world.fails = false;
  EXPECT_THROW(tick(sim, world, [&] { throw std::logic_error("ours"); }), std::logic_error);
}

}  // namespace
}  // namespace sumogamma
