#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "model/geometric_constraints.h"
#include "model/nearby.h"
#include "model/velocity_obstacle.h"
#include "support/open_scene.h"

namespace sumogamma {
namespace {

using test::add_agent;
using test::all_velocities;
using test::draw;
using test::open_model;
using test::random_scene;

const Model& shared_model() {
  static const Model model = open_model(2);
  return model;
}

TEST(GammaLaws, HardPlanesAlwaysHoldAndSpeedStaysInItsDisc) {
  const Model& model = shared_model();
  Workers workers(1);
  TickGeometry geometry;
  Workspace work;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = random_scene(model, seed, 30, seed % 3 == 0 ? 8.0 : 40.0);
    prepare_tick(model, scene, workers, geometry);
    for (std::size_t row = 0; row < scene.size(); ++row) {
      const Vec2 v = gamma_velocity(model, scene, geometry, row, scene.behavior[row], work);
      ASSERT_TRUE(v.allFinite());
      for (std::size_t k = 0; k < work.constraints.hard_count; ++k)
        ASSERT_GE(slack(work.constraints.planes[k], v), -1e-9) << "v_new lies in K";
      ASSERT_LE(v.norm(), std::max(scene.preferred_speed[row], work.preferred.norm()) + 1e-9);
      if (work.result.violation > 0) continue;
      for (const HalfPlane& plane : work.constraints.planes)
        ASSERT_GE(slack(plane, work.result.point), -1e-9);
    }
  }
}

/// One search for all hypotheses of a row finds what a search for each of them does.
TEST(GammaLaws, OneSearchForManyHypothesesGivesTheSameBits) {
  Model model = shared_model();
  model.options.use_guard = false;
  Workers workers(1);
  TickGeometry geometry;
  Workspace work, other_work;
  Nearby nearby;
  std::size_t bound = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Scene scene = random_scene(model, seed, 30, seed % 3 == 0 ? 8.0 : 25.0);
    prepare_tick(model, scene, workers, geometry);
    for (std::size_t row = 0; row < scene.size(); ++row) {
      BehaviorState behavior = scene.behavior[row];
      const AttentionRange own = behavior.attention;
      find_nearby(model.road, geometry, row, {own.front + 2.0, own.rear}, nearby);
      for (const double farther : {0.0, 2.0})
        for (const double turn : {0.0, 1.0, -2.0}) {
          behavior.attention.front = own.front + farther;
          behavior.responsibility = farther > 0 ? 0.2 : 0.5;
          behavior.intention.goal =
              scene.position[row] +
              from_body(scene.behavior[row].intention.goal - scene.position[row],
                        direction_of(turn));
          const Vec2 alone = gamma_velocity(model, scene, geometry, row, behavior, work);
          const Vec2 among =
              gamma_velocity_among(model, scene, geometry, behavior, nearby, other_work);
          ASSERT_EQ(alone, among);
          ASSERT_EQ(work.neighbours.attended.size(), other_work.neighbours.attended.size());
          bound += work.binding_source() != nullptr;
        }
    }
  }
  EXPECT_GT(bound, 500u);
}

TEST(GammaLaws, TwoWhoTakeHalfEachDoNotCollideWithinTheHorizon) {
  // Eq. 5 for both with responsibility 0.5: the new relative velocity lies outside VO^tau
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    const OrientedBox a{Vec2(0, 0), direction_of(draw(seed, 1, -kPi, kPi)), Vec2(2.4, 1.0)};
    const OrientedBox b{Vec2(draw(seed, 2, -15, 15), draw(seed, 3, -15, 15)),
                        direction_of(draw(seed, 4, -kPi, kPi)), Vec2(0.8, 0.5)};
    if (separation(a, b) <= 0) continue;
    const Vec2 va(draw(seed, 5, -5, 5), draw(seed, 6, -5, 5)),
        vb(draw(seed, 7, -5, 5), draw(seed, 8, -5, 5));
    const NearSide from_a = BoxDifference(b, a).near_side(),
                   from_b = BoxDifference(a, b).near_side();
    const Escape ea = nearest_escape(from_a, va - vb, 4.0),
                 eb = nearest_escape(from_b, vb - va, 4.0);
    // any velocities on the two free sides
    const Vec2 na = va + 0.5 * ea.change + draw(seed, 9, 1e-6, 3) * ea.normal +
                    draw(seed, 10, -3, 3) * left_of(ea.normal);
    const Vec2 nb = vb + 0.5 * eb.change + draw(seed, 11, 1e-6, 3) * eb.normal +
                    draw(seed, 12, -3, 3) * left_of(eb.normal);
    for (int k = 0; k <= 400; ++k) {
      const double t = 4.0 * k / 400;
      const OrientedBox at{a.center + t * na, a.forward, a.half},
          bt{b.center + t * nb, b.forward, b.half};
      ASSERT_GE(separation(at, bt), -1e-6) << t;
    }
  }
}

Scene transformed(const Scene& scene, double turn, bool mirror) {
  Scene out = scene;
  const Vec2 axis = direction_of(turn);
  auto move = [&](const Vec2& p) { return from_body(mirror ? Vec2(p.x(), -p.y()) : p, axis); };
  for (std::size_t row = 0; row < scene.size(); ++row) {
    out.position[row] = move(scene.position[row]);
    out.velocity[row] = move(scene.velocity[row]);
    out.heading[row] = wrap_angle(turn + (mirror ? -1.0 : 1.0) * scene.heading[row]);
    out.steering[row] = mirror ? -scene.steering[row] : scene.steering[row];
    out.behavior[row].intention.goal = move(scene.behavior[row].intention.goal);
  }
  return out;
}

TEST(GammaLaws, TurnTheSceneTurnTheAnswer) {
  const Model& model = shared_model();
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = random_scene(model, seed, 12, 30);
    const double turn = draw(seed, 999, -3, 3);
    const auto before = all_velocities(model, scene),
               after = all_velocities(model, transformed(scene, turn, false));
    for (std::size_t row = 0; row < scene.size(); ++row) {
      // the order of the planes may change, so infeasible ones agree within the solver's slack
      EXPECT_NEAR((from_body(before[row], direction_of(turn)) - after[row]).norm(), 0, 0.05);
      compared += (from_body(before[row], direction_of(turn)) - after[row]).norm() < 1e-6;
    }
  }
  EXPECT_GT(compared, 1100);
}

TEST(GammaLaws, MirrorTheSceneAndTheRuleOfTheRoadMirrorTheAnswer) {
  Model left = open_model();
  left.options.keep_left = true;
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = random_scene(shared_model(), seed, 12, 30);
    const auto before = all_velocities(shared_model(), scene),
               after = all_velocities(left, transformed(scene, 0, true));
    for (std::size_t row = 0; row < scene.size(); ++row)
      compared += (Vec2(before[row].x(), -before[row].y()) - after[row]).norm() < 1e-6;
  }
  EXPECT_GT(compared, 1150) << "of 1200; infeasible ones may differ within the solver's slack";
}

TEST(GammaLaws, WhoIsFarAwayDoesNotMatter) {
  const Model& model = shared_model();
  Scene scene = random_scene(model, 3, 20, 40);
  const auto before = all_velocities(model, scene);
  add_agent(model, scene, "bus", Vec2(5000, 5000), 0, 5, Vec2(6000, 5000), 5);
  const auto after = all_velocities(model, scene);
  for (std::size_t row = 0; row < before.size(); ++row) EXPECT_EQ(before[row], after[row]);
}

TEST(GammaLaws, FindsTheNeighboursOfABruteForceSearch) {
  const Model& model = shared_model();
  Workers workers(1);
  TickGeometry geometry;
  Neighbours neighbours;
  std::size_t attended = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    Scene scene = random_scene(model, seed, 41 + seed % 7, 15.0 + 5.0 * static_cast<double>(seed));
    if (seed % 4 == 0)
      for (Vec2& p : scene.position) p += Vec2(1e6, -1e6);
    if (seed % 5 == 0) scene.position[3] = {1e7, 0};
    prepare_tick(model, scene, workers, geometry);
    for (std::size_t row = 0; row < scene.size(); ++row) {
      const AgentGeometry& own = geometry.agent[row];
      const Vec2 preferred(draw(seed, 77, -3, 3), draw(seed, 78, -3, 3));
      find_neighbours(model.road, geometry, row, own.attention, preferred, 3.0, neighbours);
      std::vector<std::uint32_t> near = neighbours.near, near_expected, expected;
      for (std::uint32_t other = 0; other < scene.size(); ++other) {
        if (other == row) continue;
        const AgentGeometry& their = geometry.agent[other];
        const Vec2 offset = their.position - own.position;
        const double distance = offset.norm();
        if (distance <= own.next_reach + their.next_reach) near_expected.push_back(other);
        const double gap = distance - own.radius - their.radius;
        const double approach = std::max((own.velocity - their.velocity).dot(offset),
                                         (preferred - their.velocity).dot(offset)) /
                                distance;
        const bool out_of_reach = gap > 0 && gap > 3.0 * (approach + 0.3);
        if (attends(own, their, own.attention) && !out_of_reach) expected.push_back(other);
      }
      std::sort(near.begin(), near.end());
      ASSERT_EQ(near, near_expected) << row;
      ASSERT_EQ(neighbours.attended.size(), expected.size()) << row;
      for (std::size_t k = 0; k < expected.size(); ++k)
        ASSERT_EQ(neighbours.attended[k].row, expected[k]) << "in order of id";
      attended += expected.size();
    }
  }
  EXPECT_GT(attended, 3000u);
}

TEST(GammaLaws, TheNextBodyIsTheTrackedOne) {
  // the guard's own look ahead is used where there is one: bit for bit the same body
  for (bool guard : {true, false}) {
    Model model = shared_model();
    model.options.use_guard = guard;
    Workers workers(1);
    TickGeometry geometry;
    Workspace work;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Scene scene = random_scene(model, seed, 30, 25);
      prepare_tick(model, scene, workers, geometry);
      for (std::size_t row = 0; row < scene.size(); ++row) {
        const Vec2 v = gamma_velocity(model, scene, geometry, row, scene.behavior[row], work);
        for (double dt : {model.options.step, 0.1}) {
          const BodyState next = next_body(model, scene, row, v, dt, work),
                          tracked = track_velocity(model, scene, row, v, dt);
          ASSERT_EQ(next.position, tracked.position);
          ASSERT_EQ(next.velocity, tracked.velocity);
          ASSERT_EQ(next.heading, tracked.heading);
          ASSERT_EQ(next.steering, tracked.steering);
        }
      }
    }
  }
}

TEST(GammaLaws, SharesOfAPairAddUpToOne) {
  const Model& model = shared_model();
  Workers workers(1);
  TickGeometry geometry;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Scene scene = random_scene(model, seed, 20, 20);
    prepare_tick(model, scene, workers, geometry);
    for (std::size_t a = 0; a < scene.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const double sum = responsibility_share(model, scene, geometry, a, b, scene.behavior[a]) +
                           responsibility_share(model, scene, geometry, b, a, scene.behavior[b]);
        EXPECT_GE(sum, 1.0 - 1e-12) << "nobody relies on one who doesn't look";
        if (attends(geometry.agent[a], geometry.agent[b], geometry.agent[a].attention) &&
            attends(geometry.agent[b], geometry.agent[a], geometry.agent[b].attention)) {
          EXPECT_NEAR(sum, 1.0, 1e-12);
        }
      }
  }
}

TEST(GammaLaws, ReachFollowsFromSpeedSoThatFastTrafficIsSeenInTime) {
  const Model& model = shared_model();
  Scene scene;
  add_agent(model, scene, "car", Vec2(0, 0), 0, 30, Vec2(1000, 0), 30);
  add_agent(model, scene, "car", Vec2(150, 0), 0, 0, Vec2(1000, 0), 0.01);
  Workers workers(1);
  TickGeometry geometry;
  prepare_tick(model, scene, workers, geometry);
  EXPECT_TRUE(attends(geometry.agent[0], geometry.agent[1], geometry.agent[0].attention));
  for (int k = 0; k < 400; ++k) {
    test::step(model, scene, 0.05);
    ASSERT_FALSE(test::overlap(scene, 0, 1));
  }
}

TEST(GammaLaws, DegenerateScenesGiveFiniteAnswers) {
  const Model& model = shared_model();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Scene scene = random_scene(model, 1, 10, 5);
  for (std::size_t row = 0; row < 4; ++row) scene.position[row] = Vec2(1, 1);  // coincident
  scene.footprint[4] = box_footprint(0, 0);
  scene.footprint[5] = box_footprint(3, 0);
  scene.footprint[6].count = 0;
  scene.velocity[7] = scene.velocity[8];
  for (const Vec2& origin : {Vec2(0, 0), Vec2(1e6, -1e6)}) {
    Scene moved = scene;
    for (Vec2& p : moved.position) p += origin;
    for (BehaviorState& b : moved.behavior) b.intention.goal += origin;
    for (double dt : {0.01, 0.05, 0.5}) {
      Scene run = moved;
      Model m = model;
      m.options.step = dt;
      for (int k = 0; k < 20; ++k) test::step(m, run, dt);
      for (std::size_t row = 0; row < run.size(); ++row)
        ASSERT_TRUE(run.position[row].allFinite()) << row;
    }
  }
  scene.position[0] = {kNan, 0};
  scene.velocity[1] = {kNan, kNan};
  scene.heading[2] = kNan;
  scene.behavior[3].intention.goal = {kNan, kNan};
  for (const Vec2& v : all_velocities(model, scene)) EXPECT_TRUE(v.allFinite());
}

TEST(GammaLaws, TenThousandInOneCellAreAnswered) {
  const Model& model = shared_model();
  Scene scene;
  for (int k = 0; k < 10000; ++k)
    add_agent(model, scene, "pedestrian", Vec2(0.001 * (k % 100), 0.001 * (k / 100)), 0, 1,
              Vec2(100, 0), 1.3);
  Workers workers(1);
  TickGeometry geometry;
  prepare_tick(model, scene, workers, geometry);
  Workspace work;
  for (std::size_t row = 0; row < scene.size(); row += 2500)
    EXPECT_TRUE(gamma_velocity(model, scene, geometry, row, scene.behavior[row], work).allFinite());
}

}  // namespace
}  // namespace sumogamma
