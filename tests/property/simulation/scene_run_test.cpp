#include "simulation/scene_run.h"

#include <gtest/gtest.h>

#include "geometry/convex_polygon.h"
#include "geometry/oriented_box.h"
#include "model/tracking.h"
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

bool overlapping(const AgentType& type, const BodyState& a, const BodyState& b) {
  const Vec2 half(0.5 * type.length, 0.5 * type.width);
  return separation(OrientedBox{a.position, direction_of(a.heading), half},
                    OrientedBox{b.position, direction_of(b.heading), half}) < -1e-6;
}

/// Fewest steps after which two cars that start from rest can be apart, over all pairs of ways to
/// hold the wheels at full throttle or to stand.
std::size_t quickest_separation(const AgentType& type, const BodyState& a, const BodyState& b) {
  constexpr int kWays = 9;
  constexpr std::size_t kSteps = 40;
  std::vector<std::vector<BodyState>> ways[2];
  for (int body = 0; body < 2; ++body)
    for (int way = 0; way <= kWays; ++way) {
      BodyState state = body == 0 ? a : b;
      const double angle = type.max_steering * (2.0 * way / (kWays - 1) - 1.0);
      const double slip = std::atan(type.rear_axle_to_center / type.wheelbase * std::tan(angle));
      std::vector<BodyState> states;
      for (std::size_t k = 0; k < kSteps; ++k) {
        const Vec2 ask = way < kWays ? Vec2(4.0 * direction_of(state.heading + slip)) : Vec2(0, 0);
        state = advance_body(type, state, ask, 0.05);
        states.push_back(state);
      }
      ways[body].push_back(states);
    }
  std::size_t best = kSteps;
  for (const auto& first : ways[0])
    for (const auto& second : ways[1])
      for (std::size_t k = 0; k < best; ++k)
        if (!overlapping(type, first[k], second[k])) best = k;
  return best;
}

TEST(SceneRun, OverlappingCarsComeApartAboutAsSoonAsTheirBodiesAllow) {
  double allowed = 0, taken = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SceneFile file = empty_scene("overlap");
    const auto draw = [&](std::uint64_t k, double low, double high) {
      return random_uniform(seed, k, 0, Draw::Demand, low, high);
    };
    const Vec2 aside{draw(1, -2, 2), draw(2, 0.5, 1.5)};
    add_agent(file, "Car", Vec2(0, 0), 0, Vec2(100, 0), 4);
    add_agent(file, "Car", aside, 0, aside + Vec2(100, 0), 4);
    const AgentType& type = type_of(file.types, file.scene.type[0]);
    allowed += static_cast<double>(
        quickest_separation(type, body_of(file.scene, 0), body_of(file.scene, 1)));
    Workers workers(1);
    run_scene(file, ModelOptions{}, 100, 0.05, workers, [&](const Scene& scene) {
      if (scene.tick > 0) taken += overlapping(type, body_of(scene, 0), body_of(scene, 1));
    });
  }
  RecordProperty("steps_allowed", std::to_string(allowed));
  RecordProperty("steps_taken", std::to_string(taken));
  EXPECT_GE(allowed, 30 * 10) << "it takes them more than half a second";
  EXPECT_LE(taken, 1.05 * allowed);
}

/// Two streams of people and bicycles that meet head-on in a passage.
SceneFile passage(std::uint64_t seed) {
  SceneFile file = empty_scene("passage");
  for (int k = 0; k < 60; ++k) {
    const double way = k % 2 == 0 ? 1 : -1;
    const double jitter =
        random_uniform(seed, static_cast<std::uint64_t>(k), 0, Draw::Demand, -0.3, 0.3);
    const Vec2 position(way * (-40 + 2.5 * (k / 6)), 1.5 * ((k / 2) % 3 - 1) + jitter);
    add_agent(file, k % 6 < 4 ? "People" : "Bicycle", position, way > 0 ? 0 : kPi,
              Vec2(way * 80, position.y()), k % 6 < 4 ? 1.3 : 2.5);
  }
  return file;
}

TEST(SceneRun, StreamsThatMeetInAPassageGetThrough) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const SceneReport report = run(passage(seed), 1000, 2);
    expect_lawful(report);
    EXPECT_LE(report.agents_overlapped_share, 0.05);
    EXPECT_EQ(report.stuck_share, 0);
    EXPECT_GE(report.progress_mean, 0.8);
  }
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
