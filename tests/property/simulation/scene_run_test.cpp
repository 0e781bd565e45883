#include "simulation/scene_run.h"

#include <gtest/gtest.h>

#include "geometry/convex_polygon.h"
#include "support/made_scenes.h"

namespace sumogamma {
namespace {

using test::add_agent;
using test::empty_scene;
using test::mixed_scene;
using test::ring_scene;

SceneReport run(const SceneFile& file, std::size_t steps, std::size_t threads = 1,
                double dt = 0.05) {
  Workers workers(threads);
  return run_scene(file, ModelOptions{}, steps, dt, workers);
}

void expect_lawful(const SceneReport& report) {
  EXPECT_EQ(report.reversal_share, 0);
  EXPECT_EQ(report.kinematics_violation_share, 0);
  EXPECT_EQ(report.hard_violation_share, 0);
}

TEST(SceneRun, GivesTheSameBitsForAnyNumberOfThreads) {
  const SceneFile file = mixed_scene(1, 250, 28);
  const SceneReport one = run(file, 60, 1);
  for (std::size_t threads : {2u, 3u, 7u}) {
    const SceneReport many = run(file, 60, threads);
    EXPECT_EQ(many.state_hash, one.state_hash) << threads;
    EXPECT_EQ(many.pairs_per_agent, one.pairs_per_agent);
    EXPECT_EQ(many.infeasible_share, one.infeasible_share);
  }
}

TEST(SceneRun, DenseCrowdsOfAnySeedFlowWithNextToNoContact) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const SceneReport report = run(mixed_scene(seed, 300, 36), 200, 2);
    expect_lawful(report);
    EXPECT_LE(report.agents_overlapped_share, 0.02);
    EXPECT_GE(report.progress_mean, 0.6);
  }
}

TEST(SceneRun, TicksOfAnyLengthStaySafe) {
  for (double dt : {0.02, 0.1, 0.2}) {
    SCOPED_TRACE(dt);
    const SceneReport report =
        run(mixed_scene(3, 150, 45), static_cast<std::size_t>(10 / dt), 2, dt);
    expect_lawful(report);
    EXPECT_LE(report.agents_overlapped_share, 0.04);
  }
}

TEST(SceneRun, ExactHeadOnIsResolvedOnTheRight) {
  for (const char* first : {"People", "Bicycle", "Car", "Bus"})
    for (const char* second : {"People", "Scooter", "Van"}) {
      SCOPED_TRACE(std::string(first) + " " + second);
      SceneFile file = empty_scene("head-on");
      add_agent(file, first, Vec2(0, 0), 0, Vec2(100, 0), 2);
      add_agent(file, second, Vec2(25, 0), kPi, Vec2(-75, 0), 2);
      Workers workers(1);
      double lowest = 0;
      const SceneReport report =
          run_scene(file, ModelOptions{}, 400, 0.05, workers,
                    [&](const Scene& scene) { lowest = std::min(lowest, scene.position[0].y()); });
      EXPECT_EQ(report.agents_overlapped_share, 0);
      EXPECT_EQ(report.stuck_share, 0);
      EXPECT_GT(report.progress_mean, 0.8);
      EXPECT_LT(lowest, -0.05) << "the one going +x passes below";
    }
}

TEST(SceneRun, AParkedCarIsPassed) {
  for (double aside : {0.0, 0.1, -0.2}) {
    SceneFile file = empty_scene("parked");
    add_agent(file, "Car", Vec2(0, 0), 0, Vec2(100, 0), 4);
    add_agent(file, "Car", Vec2(25, aside), 0, Vec2(125, aside), 0.0001);
    const SceneReport report = run(file, 400);
    EXPECT_EQ(report.agents_overlapped_share, 0);
    EXPECT_EQ(report.stuck_share, 0);
    EXPECT_GT(report.progress_mean, 0.4);
  }
}

TEST(SceneRun, FourAtOnceAndEightAtOnceFindThrough) {
  for (int count : {4, 8}) {
    const SceneReport report = run(ring_scene("Car", count, 6.0 * count / 2, 4), 600);
    EXPECT_EQ(report.agents_overlapped_share, 0) << count;
    EXPECT_EQ(report.stuck_share, 0) << count;
  }
}

TEST(SceneRun, ARingOfTwoHundredPeopleFindsThrough) {
  const SceneReport report = run(ring_scene("People", 200, 50, 1.3), 2400, 2);
  EXPECT_LE(report.agents_overlapped_share, 0.05);
  EXPECT_LE(report.stuck_share, 0.05);
}

TEST(SceneRun, OverlapComesApart) {
  SceneFile file = empty_scene("overlap");
  add_agent(file, "Car", Vec2(0, 0), 0, Vec2(100, 0), 4);
  add_agent(file, "Car", Vec2(0.8, 1.1), 0, Vec2(100.8, 1.1), 4);
  add_agent(file, "People", Vec2(50, 50), 0, Vec2(150, 50), 1.2);
  add_agent(file, "People", Vec2(50.05, 50.02), 2, Vec2(0, 150), 1.2);
  Workers workers(1);
  std::size_t together = 0;
  Vec2 last(0, 0);
  double fastest = 0;
  run_scene(file, ModelOptions{}, 100, 0.05, workers, [&](const Scene& scene) {
    if (scene.tick > 0) fastest = std::max(fastest, (scene.position[0] - last).norm() / 0.05);
    last = scene.position[0];
    const bool apart =
        overlap_depth(place_polygon(scene.footprint[0].outline(), direction_of(scene.heading[0])),
                      place_polygon(scene.footprint[1].outline(), direction_of(scene.heading[1])),
                      scene.position[1] - scene.position[0]) <= 1e-6;
    together += !apart;
  });
  EXPECT_LE(together, 30u) << "a second and a half";
  EXPECT_LE(fastest, 4.1) << "nobody teleports";
}

}  // namespace
}  // namespace sumogamma
