#include "model/obstacle_constraints.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/open_scene.h"

namespace sumogamma {
namespace {

using test::add_agent;
using test::draw;
using test::open_model;
using test::step;

double brute_distance(const ConvexPolygon& outline, const Vec2& from, const Vec2& to) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 400; ++i) {
    const Vec2 p = from + (i / 400.0) * (to - from);
    for (std::uint32_t k = 0; k < outline.count; ++k)
      for (int j = 0; j <= 50; ++j) {
        const Vec2 q =
            outline.vertices[k] +
            (j / 50.0) * (outline.vertices[(k + 1) % outline.count] - outline.vertices[k]);
        least = std::min(least, (p - q).norm());
      }
  }
  return least;
}

TEST(Clearance, IsTheShortestWayBetweenOutlineAndSide) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const ConvexPolygon outline =
        place_polygon(box_footprint(4, 2).outline(), direction_of(draw(seed, 1, -3, 3)));
    const Vec2 from(draw(seed, 2, -8, 8), draw(seed, 3, -8, 8)),
        to(draw(seed, 4, -8, 8), draw(seed, 5, -8, 8));
    const Clearance clear = clearance(outline, from, to);
    EXPECT_NEAR(clear.outward.norm(), 1, 1e-9);
    if (clear.distance == 0) continue;
    EXPECT_NEAR(clear.distance, brute_distance(outline, from, to), 0.05);
    // the plane across the shortest way separates the two
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = 0; k < outline.count; ++k)
      nearest = std::min(nearest, clear.outward.dot(outline.vertices[k]));
    EXPECT_NEAR(nearest - std::max(clear.outward.dot(from), clear.outward.dot(to)), clear.distance,
                1e-9);
  }
}

TEST(Clearance, KnowsWhatCrossesAndWhatIsPointLike) {
  const ConvexPolygon outline = place_polygon(box_footprint(4, 2).outline(), Vec2(1, 0));
  EXPECT_EQ(clearance(outline, Vec2(-9, 0.5), Vec2(9, 0.5)).distance, 0);
  EXPECT_EQ(clearance(outline, Vec2(-0.5, 0.1), Vec2(0.5, 0.2)).distance, 0) << "wholly inside";
  EXPECT_LT(clearance(outline, Vec2(-9, 0.5), Vec2(9, 0.5)).outward.y(), 0)
      << "out to where the centre is";
  EXPECT_NEAR(clearance(outline, Vec2(5, 0), Vec2(5, 0)).distance, 3, 1e-9);
}

/// A room with a concave corner:
///   +--------+
///   |   +----+     walls at x = 0, y = 0, y = 20 ... ; the block x > 8, y > 8 is solid
///   |   |
///   +---+
std::vector<Obstacle> concave_room() {
  return {{ObstacleKind::Building, {{-1, -1}, {9, -1}, {9, 0}, {0, 0}, {0, 20}, {-1, 20}}},
          {ObstacleKind::Barrier, {{0, 20}, {20, 20}, {20, 12}, {8, 12}, {8, 0}}}};
}

TEST(ObstacleConstraints, NobodyWalksOrDrivesIntoAWallHoweverMuchHeWantsTo) {
  Model model = open_model();
  model.road.obstacles = concave_room();
  model.obstacles = ObstacleIndex(model.road.obstacles);
  for (const char* type : {"pedestrian", "bicycle", "car"})
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(std::string(type) + " " + std::to_string(seed));
      Scene scene;
      add_agent(model, scene, type, Vec2(4, 5), draw(seed, 1, -3, 3), 0,
                Vec2(draw(seed, 2, -40, 40), draw(seed, 3, -40, 40)), 4);
      for (int k = 0; k < 400; ++k) {
        step(model, scene, 0.05);
        for (const Obstacle& obstacle : model.road.obstacles)
          for (std::size_t m = 0; m + 1 < obstacle.outline.size(); ++m) {
            const ConvexPolygon outline =
                place_polygon(scene.footprint[0].outline(), direction_of(scene.heading[0]));
            const Clearance clear = clearance(outline, obstacle.outline[m] - scene.position[0],
                                              obstacle.outline[m + 1] - scene.position[0]);
            ASSERT_GT(clear.distance, 0) << "tick " << k << " side " << m;
          }
      }
    }
}

TEST(ObstacleConstraints, EveryPlaneAdmitsStandingEvenInsideAWall) {
  Model model = open_model();
  model.road.obstacles = concave_room();
  model.obstacles = ObstacleIndex(model.road.obstacles);
  Workers workers(1);
  TickGeometry geometry;
  std::vector<std::uint32_t> found;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Scene scene;
    add_agent(model, scene, "van", Vec2(draw(seed, 1, -3, 12), draw(seed, 2, -3, 22)),
              draw(seed, 3, -3, 3), 3, Vec2(0, 0), 3);
    prepare_tick(model, scene, workers, geometry);
    ConstraintSet set;
    append_obstacle_constraints(model, scene, geometry, 0, found, set);
    for (const HalfPlane& plane : set.planes) EXPECT_GE(slack(plane, Vec2(0, 0)), 0);
  }
}

TEST(ObstacleIndex, KnowsWhatStandsBetweenTwoPlaces) {
  Obstacle house;
  house.outline = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const ObstacleIndex index({house});
  EXPECT_TRUE(index.is_between({-3, 0}, {3, 0}));
  EXPECT_TRUE(index.is_between({-3, 0}, {0, 0})) << "from outside to inside";
  EXPECT_FALSE(index.is_between({-3, 0}, {-1.1, 0}));
  EXPECT_FALSE(index.is_between({-3, 2}, {3, 2}));
  EXPECT_FALSE(ObstacleIndex().is_between({-3, 0}, {3, 0}));
}

TEST(ObstacleIndex, FindsTheSidesOfABruteForceSearch) {
  const ObstacleIndex index(concave_room());
  std::vector<std::uint32_t> found;
  index.find_near(Vec2(4, 5), 4.5, found);
  EXPECT_EQ(found.size(), 2u) << "the left wall and the inner block";
  index.find_near(Vec2(4, 5), 1000, found);
  EXPECT_EQ(found.size(), 10u);
  index.find_near(Vec2(std::nan(""), 5), 10, found);
  EXPECT_TRUE(found.empty());
  ObstacleIndex().find_near(Vec2(0, 0), 10, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace sumogamma
