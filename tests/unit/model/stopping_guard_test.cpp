#include "model/stopping_guard.h"

#include <gtest/gtest.h>

#include <array>

#include "support/open_scene.h"

namespace sumogamma {
namespace {

using test::add_agent;
using test::draw;
using test::open_model;
using test::overlap;
using test::random_scene;
using test::step;

const Model& shared_model() {
  static const Model model = open_model(2);
  return model;
}

/// Rows of a random scene that overlap nobody.
Scene apart_scene(const Model& model, std::uint64_t seed, std::size_t count, double side) {
  const Scene all = random_scene(model, seed, count, side);
  std::vector<bool> removed(all.size(), false);
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (!removed[b] && (all.position[a] - all.position[b]).norm() <
                             all.footprint[a].radius + all.footprint[b].radius + 0.3)
        removed[a] = true;
  Scene scene = all;
  remove_agents(scene, removed);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    scene.speed[row] = 0;
    scene.velocity[row] = Vec2::Zero();
  }
  return scene;
}

TEST(StoppingGuard, BodiesThatAreApartStayApartInADenseCrowd) {
  const Model& model = shared_model();
  std::size_t agents = 0, pairs = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Scene scene = apart_scene(model, seed, 120, 45);
    agents += scene.size();
    for (int k = 0; k < 200; ++k) {
      step(model, scene, 0.05);
      for (std::size_t a = 0; a < scene.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          if ((scene.position[a] - scene.position[b]).squaredNorm() < 200 && overlap(scene, a, b))
            ++pairs;
    }
  }
  EXPECT_GT(agents, 500u);
  EXPECT_LE(pairs, agents / 50) << "pair-ticks in overlap";
}

TEST(StoppingGuard, BrakesForAWallOfPeopleThatHalfPlanesWouldTurnInto) {
  // a car that is told to turn hard beside a standing pedestrian: its side would sweep over him
  const Model& model = shared_model();
  Scene scene;
  add_agent(model, scene, "car", Vec2(0, 0), 0, 3, Vec2(0, 50), 5);
  add_agent(model, scene, "pedestrian", Vec2(-0.5, 1.25), 0, 0, Vec2(-0.5, 1.25), 0.01);
  for (int k = 0; k < 200; ++k) {
    step(model, scene, 0.05);
    ASSERT_FALSE(overlap(scene, 0, 1)) << k;
  }
}

TEST(StoppingGuard, AdmitsBrakingWhereverEverybodyCanBrake) {
  const Model& model = shared_model();
  Workers workers(1);
  TickGeometry geometry;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Scene scene = apart_scene(model, seed, 60, 40);
    Neighbours neighbours;
    StoppingGuard guard;
    for (int k = 0; k < 60; ++k) {
      prepare_tick(model, scene, workers, geometry);
      for (std::size_t row = 0; row < scene.size(); ++row) {
        find_neighbours(model.road, geometry, row, {5, 2}, Vec2(0, 0), 3, neighbours);
        guard.prepare(model, scene, geometry, row, neighbours.near);
        EXPECT_TRUE(guard.admits(Vec2(0, 0))) << "seed " << seed << " tick " << k << " row " << row;
      }
      step(model, scene, 0.05);
    }
  }
}

// somebody in a crowd crept a centimetre a second into a bicycle that stood beside, 14 cm in the
// end
TEST(StoppingGuard, NobodyOnFootGetsDeepIntoABodyThatItTouches) {
  const Model& model = shared_model();
  Workers workers(1);
  TickGeometry geometry;
  const auto may_creep_on_from = [&](double depth) {
    Scene scene;
    add_agent(model, scene, "bicycle", Vec2(0, 0), 0, 0, Vec2(0.01, 0), 0.01);
    add_agent(model, scene, "pedestrian", Vec2(0, 2), 0, 0, Vec2(0, 2), 0.01);
    scene.context[1].active = true;
    prepare_tick(model, scene, workers, geometry);
    const double apart = 2.0 + overlap_depth(scene, geometry, 1, 0);  // that is negative
    scene.position[1] = Vec2(0, apart - depth);
    prepare_tick(model, scene, workers, geometry);
    EXPECT_NEAR(overlap_depth(scene, geometry, 1, 0), depth, 0.01);
    const std::array<std::uint32_t, 1> near = {0};
    StoppingGuard guard;
    guard.prepare(model, scene, geometry, 1, near);
    EXPECT_TRUE(guard.admits(Vec2(0, 0.1))) << "off it";
    return guard.admits(Vec2(0, -0.01));
  };
  EXPECT_TRUE(may_creep_on_from(0.02));
  EXPECT_FALSE(may_creep_on_from(0.06));
}

TEST(StoppingGuard, LeavesAFreeBodyAlone) {
  const Model& model = shared_model();
  Scene scene;
  add_agent(model, scene, "car", Vec2(0, 0), 0, 5, Vec2(100, 0), 5);
  Workers workers(1);
  TickGeometry geometry;
  prepare_tick(model, scene, workers, geometry);
  StoppingGuard guard;
  guard.prepare(model, scene, geometry, 0, {});
  EXPECT_EQ(guarded_velocity(guard, model, scene, geometry, 0, Vec2(5, 0.3), Vec2(5, 0), {}),
            Vec2(5, 0.3));
}

}  // namespace
}  // namespace sumogamma
