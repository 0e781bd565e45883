#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "planning/dubins.h"
#include "planning/hybrid_astar.h"

namespace sumogamma {
namespace {

double uniform(std::uint64_t seed, std::uint64_t number, double low, double high) {
  return random_uniform(seed, number, 0, Draw::ProcessNoise, low, high);
}

WheeledShape car() {
  const AgentTypeTable types = default_agent_types();
  return wheeled_shape(type_of(types, find_agent_type(types, "car")));
}

TEST(DubinsLaws, EndsAtItsGoalAndIsNoShorterThanTheStraightLine) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const AxlePose from{Vec2(uniform(seed, 0, -20, 20), uniform(seed, 1, -20, 20)),
                        uniform(seed, 2, -4, 4)};
    const AxlePose to{Vec2(uniform(seed, 3, -20, 20), uniform(seed, 4, -20, 20)),
                      uniform(seed, 5, -4, 4)};
    const DubinsWay way = dubins_way(from, to, 5);
    AxlePose pose = from;
    for (const auto& piece : way.pieces) {
      EXPECT_GE(piece.length, 0);
      EXPECT_LE(std::abs(piece.curvature), 0.2 + 1e-12);
      pose = rolled(pose, piece.length, piece.curvature);
    }
    EXPECT_NEAR((pose.position - to.position).norm(), 0, 1e-6);
    EXPECT_NEAR(wrapped(pose.heading - to.heading), 0, 1e-9);
    EXPECT_GE(way.length(), (to.position - from.position).norm() - 1e-9);
    // mirrored and driven from the other end it is as long
    const AxlePose back_from{to.position, to.heading + M_PI},
        back_to{from.position, from.heading + M_PI};
    EXPECT_NEAR(dubins_way(back_from, back_to, 5).length(), way.length(), 1e-6);
  }
}

/// Bodies strewn over a road that winds; whatever way is found can be driven and touches nothing.
TEST(HybridAStarLaws, FoundWaysAreWithinSteeringAndOffEverythingSolid) {
  const WheeledShape shape = car();
  int found_ways = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Path road;
    std::vector<Vec2> points;
    for (int i = -20; i <= 70; ++i) points.emplace_back(i, 3 * std::sin(i / 15.0));
    road.line = Polyline(points);
    PathStretch stretch;
    stretch.to = road.line.length();
    stretch.room_left = 7.0;
    stretch.room_right = 2.5;
    road.stretches = {stretch};
    std::vector<OrientedBox> bodies;
    for (std::uint64_t i = 0; i < 3; ++i) {
      const double along = uniform(seed, 10 + i, 30, 55), aside = uniform(seed, 20 + i, -2, 5.5);
      const Vec2 forward = direction_of(uniform(seed, 30 + i, -0.6, 0.6));
      bodies.push_back({road.line.point_at(along) + aside * left_of(road.line.direction_at(along)),
                        forward, Vec2(uniform(seed, 40 + i, 0.3, 2.4), 0.9)});
    }
    const Wall wall{Vec2(uniform(seed, 50, 15, 40), 9), Vec2(uniform(seed, 51, 15, 40), 7)};
    const auto pose_at = [&](double along) {
      return AxlePose{road.line.point_at(along), heading_of(road.line.direction_at(along))};
    };
    const DrivableSpace space{&road, bodies, std::span(&wall, 1)};
    HybridAStarParameters parameters;
    parameters.most_expansions = 300;
    const FoundWay found = find_way(shape, pose_at(20), pose_at(60), space, parameters);
    if (found.result != WaySearch::Found) continue;
    ++found_ways;
    EXPECT_NEAR((found.poses.back().position - pose_at(60).position).norm(), 0, 1e-6);
    for (std::size_t i = 0; i < found.poses.size(); ++i) {
      const OrientedBox body = body_at(shape, found.poses[i]);
      for (const OrientedBox& other : bodies) EXPECT_GT(separation(body, other), 0.0);
      if (i == 0) continue;
      const double way = (found.poses[i].position - found.poses[i - 1].position).norm();
      EXPECT_LE(way, parameters.spacing + 1e-9);
      if (way < 1e-6) continue;
      const double turn = wrapped(found.poses[i].heading - found.poses[i - 1].heading);
      EXPECT_LE(std::abs(turn) / way, 1.001 / shape.turning_radius());
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(found_ways, 50);
}

}  // namespace
}  // namespace sumogamma
