// One step for all: what a tick does is advance_rows, and who forks a world leaves it as it was.
#include "simulation/advance.h"

#include <gtest/gtest.h>

#include "support/road_traffic.h"

namespace sumogamma {
namespace {

using testing::kAgents;
using testing::RoadTraffic;

struct Fork {
  Scene scene;
  RoadState road;
  Traffic traffic;
  AdvanceWork work;
};

Fork fork_of(const Simulation& sim) { return {sim.scene, sim.road, sim.traffic, {}}; }

void advance(const Simulation& sim, Workers& workers, const AdvanceOptions& options, Fork& fork) {
  advance_rows({sim.model, workers, fork.road, fork.scene, fork.traffic, fork.work}, options);
}

/// Nobody comes or leaves any more, and lights stay.
class FrozenWorld final : public World {
 public:
  void observe(Scene&, RoadState&) override {}
  void advance(const Scene&) override {}
  bool finished() const override { return false; }
};

/// Keeps what a tick begins with.
class ForkingWorld final : public World {
 public:
  explicit ForkingWorld(RoadTraffic& traffic) : traffic_(traffic) {}
  void observe(Scene& scene, RoadState& road) override {
    traffic_.observe(scene, road);
    fork = fork_of(traffic_.sim);
  }
  void advance(const Scene&) override {}
  bool finished() const override { return false; }

  Fork fork;

 private:
  RoadTraffic& traffic_;
};

class AdvanceOn : public ::testing::TestWithParam<const char*> {};

TEST_P(AdvanceOn, GivesTheBitsOfEveryTick) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    RoadTraffic traffic(GetParam(), seed, kAgents, 1);
    ForkingWorld world(traffic);
    Workers workers(3);
    for (int k = 0; k < 300; ++k) {
      tick(traffic.sim, world);
      advance(traffic.sim, workers, {.dt = traffic.sim.dt}, world.fork);
      ASSERT_EQ(hash_state(world.fork.scene), hash_state(traffic.sim.scene)) << "tick " << k;
    }
    EXPECT_GT(traffic.sim.scene.size(), kAgents / 3);
  }
}

TEST_P(AdvanceOn, GivesTheBitsOfAHundredTicksOnEnd) {
  RoadTraffic traffic(GetParam(), 7, kAgents, 1);
  for (int k = 0; k < 400; ++k) traffic.step();
  Simulation& sim = traffic.sim;
  Workers workers(2);
  Fork fork = fork_of(sim);
  FrozenWorld frozen;
  for (int k = 0; k < 100; ++k) {
    tick(sim, frozen);
    advance(sim, workers, {.dt = sim.dt}, fork);
    ASSERT_EQ(hash_state(fork.scene), hash_state(sim.scene)) << "tick " << k;
    EXPECT_EQ(fork.traffic.state.waiting_time, sim.traffic.state.waiting_time);
    EXPECT_EQ(fork.traffic.state.backing_left, sim.traffic.state.backing_left);
  }
}

TEST_P(AdvanceOn, AForkChangesNothingInWhatItWasForkedFrom) {
  RoadTraffic traffic(GetParam(), 5, kAgents, 1), untouched(GetParam(), 5, kAgents, 1);
  Workers workers(1);
  for (int k = 0; k < 400; ++k) {
    traffic.step();
    untouched.step();
    if (k % 20 != 0) continue;
    const std::uint64_t before = hash_state(traffic.sim.scene);
    for (const bool rules : {true, false}) {
      Fork fork = fork_of(traffic.sim);
      for (int step = 0; step < 12; ++step)
        advance(traffic.sim, workers, {.dt = 1.0 / 3.0, .rules = rules, .lanes = rules}, fork);
      EXPECT_NE(hash_state(fork.scene), before);
    }
    EXPECT_EQ(hash_state(traffic.sim.scene), before);
  }
  // nor in what it does next
  EXPECT_EQ(hash_state(traffic.sim.scene), hash_state(untouched.sim.scene));
}

TEST_P(AdvanceOn, WithoutRulesNobodyIsHeldUpByOne) {
  RoadTraffic traffic(GetParam(), 9, kAgents, 1);
  traffic.sim.rules = false;
  for (int k = 0; k < 400; ++k) {
    traffic.step();
    const Scene& scene = traffic.sim.scene;
    for (std::size_t row = 0; row < scene.size(); ++row) {
      EXPECT_EQ(scene.context[row].reason, LimitReason::None);
      EXPECT_FALSE(std::isfinite(scene.context[row].allowed_speed));
    }
  }
  EXPECT_GT(traffic.sim.scene.size(), 5u);
}

TEST_P(AdvanceOn, APlannedRowIsMovedAsItIsAskedAndNobodyElseIs) {
  RoadTraffic traffic(GetParam(), 3, kAgents, 1);
  for (int k = 0; k < 200; ++k) traffic.step();
  Simulation& sim = traffic.sim;
  std::size_t ego = 0;
  while (type_of(sim.model.types, sim.scene.type[ego]).kinematics == Kinematics::Holonomic) ++ego;
  sim.scene.control[ego] = Control::Planned;
  Workers workers(2);
  Fork braking = fork_of(sim), going = fork_of(sim);
  const double before = sim.scene.speed[ego];
  int asked = 0;
  advance_rows({sim.model, workers, going.road, going.scene, going.traffic, going.work},
               {.dt = sim.dt}, [&](const TrafficView& view, std::size_t row) {
                 EXPECT_EQ(row, ego);
                 EXPECT_TRUE(view.scene.context[row].active);
                 ++asked;
                 return Vec2(10.0 * direction_of(view.scene.heading[row]));
               });
  advance(sim, workers, {.dt = sim.dt}, braking);  // nobody plans: it brakes
  EXPECT_EQ(asked, 1);
  EXPECT_GT(going.scene.speed[ego], before);
  EXPECT_LE(braking.scene.speed[ego], before);
  for (std::size_t row = 0; row < sim.scene.size(); ++row)
    if (row != ego) {
      EXPECT_EQ(going.scene.position[row], braking.scene.position[row]);
    }
}

INSTANTIATE_TEST_SUITE_P(Maps, AdvanceOn, ::testing::Values("two_way_stop", "roundabout"));

}  // namespace
}  // namespace sumogamma
