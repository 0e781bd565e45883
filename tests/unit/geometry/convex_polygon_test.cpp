#include "geometry/convex_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "geometry/oriented_box.h"
#include "geometry/rotation.h"
#include "support/random_draw.h"

namespace sumogamma {
namespace {

std::vector<Vec2> box_outline(double length, double width) {
  return {{length / 2, -width / 2},
          {length / 2, width / 2},
          {-length / 2, width / 2},
          {-length / 2, -width / 2}};
}

/// A random convex outline: points on an ellipse in order of angle.
std::vector<Vec2> random_outline(std::uint64_t seed) {
  const auto corners = 3 + random_bits(seed, 0, 1, Draw::ProcessNoise) % 6;
  std::vector<Vec2> outline;
  for (std::uint64_t k = 0; k < corners; ++k) {
    const double angle = (static_cast<double>(k) + drawn_number(seed, k, 0.05, 0.95)) * 2 * kPi /
                         static_cast<double>(corners);
    outline.push_back({3.0 * std::cos(angle), 1.2 * std::sin(angle)});
  }
  return outline;
}

ConvexPolygon random_polygon(std::uint64_t seed) {
  return place_polygon(random_outline(seed), direction_of(drawn_number(seed, 99, -kPi, kPi)));
}

/// Largest dot product of the outline's vertices with a direction: defines a convex set completely.
template <typename Outline>
double support(const Outline& outline, const Vec2& direction) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::uint32_t k = 0; k < outline.count; ++k)
    most = std::max(most, outline.vertices[k].dot(direction));
  return most;
}

template <typename Outline>
void expect_well_formed(const Outline& outline) {
  for (std::uint32_t k = 0; k < outline.count; ++k) {
    EXPECT_GE(outline.vertices[k].y(), outline.vertices[0].y() - 1e-12);
    if (outline.count < 2) continue;
    const Vec2 edge = outline.vertices[(k + 1) % outline.count] - outline.vertices[k];
    EXPECT_NEAR(outline.normals[k].norm(), 1.0, 1e-12);
    EXPECT_NEAR(outline.normals[k].dot(edge), 0.0, 1e-9);
    EXPECT_GE(cross(outline.normals[k], edge), -1e-9) << "normals point outwards";
  }
}

TEST(ConvexPolygon, StartsAtTheLowestVertexWithOutwardUnitNormals) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    expect_well_formed(random_polygon(seed));
  }
}

TEST(ConvexPolygon, MarginsMoveEachSideOfABox) {
  const ConvexPolygon grown =
      place_polygon(box_outline(4, 2), Vec2(0, 1), {.front = 0.5, .rear = 0.25, .side = 0.1});
  ASSERT_EQ(grown.count, 4u);
  EXPECT_NEAR(support(grown, Vec2(0, 1)), 2.5, 1e-12);
  EXPECT_NEAR(support(grown, Vec2(0, -1)), 2.25, 1e-12);
  EXPECT_NEAR(support(grown, Vec2(1, 0)), 1.1, 1e-12);
  EXPECT_NEAR(support(grown, Vec2(-1, 0)), 1.1, 1e-12);
}

TEST(ConvexPolygon, DropsWhatIsNoCorner) {
  const std::vector<Vec2> collinear = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 1}, {0, 1}};
  EXPECT_EQ(place_polygon(collinear, Vec2(1, 0)).count, 4u);
  const std::vector<Vec2> point = {{1, 2}, {1, 2}, {1, 2}};
  EXPECT_EQ(place_polygon(point, Vec2(1, 0)).count, 1u);
  const ConvexPolygon grown = place_polygon(point, Vec2(1, 0), {.front = 1, .rear = 1, .side = 1});
  EXPECT_EQ(grown.count, 4u);
  const std::vector<Vec2> broken = {{std::nan(""), 0},
                                    {std::numeric_limits<double>::infinity(), 1}};
  EXPECT_EQ(place_polygon(broken, Vec2(1, 0)).count, 1u);
}

TEST(MinkowskiDifference, HasTheSupportOfTheTwo) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    const ConvexPolygon a = random_polygon(2 * seed), b = random_polygon(2 * seed + 1);
    const Vec2 offset(drawn_number(seed, 7, -9, 9), drawn_number(seed, 8, -9, 9));
    const PolygonDifference difference = minkowski_difference(b, a, offset);
    expect_well_formed(difference);
    EXPECT_LE(difference.count, a.count + b.count);
    for (int k = 0; k < 64; ++k) {
      const Vec2 direction = direction_of(k * kPi / 32 + 0.01);
      EXPECT_NEAR(support(difference, direction),
                  support(b, direction) + support(a, -direction) + offset.dot(direction), 1e-9);
    }
  }
}

TEST(MinkowskiDifference, JoinsParallelEdgesAndTakesPointsAndSegments) {
  const ConvexPolygon box = place_polygon(box_outline(4, 2), Vec2(1, 0));
  EXPECT_EQ(minkowski_difference(box, box, Vec2(5, 0)).count, 4u);
  const std::vector<Vec2> point = {{0, 0}}, segment = {{-1, 0}, {1, 0}};
  const ConvexPolygon dot = place_polygon(point, Vec2(1, 0)),
                      line = place_polygon(segment, Vec2(1, 0));
  EXPECT_EQ(minkowski_difference(dot, dot, Vec2(5, 0)).count, 1u);
  EXPECT_EQ(minkowski_difference(box, dot, Vec2(5, 0)).count, 4u);
  const PolygonDifference wide = minkowski_difference(line, box, Vec2(5, 0));
  EXPECT_NEAR(support(wide, Vec2(1, 0)), 5 + 2 + 1, 1e-12);
}

TEST(BoxDifference, IsTheMinkowskiDifference) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(seed);
    const bool parallel = seed % 5 == 0;
    const double angle = drawn_number(seed, 1, -kPi, kPi);
    const double other = parallel ? angle + kPi / 2 * static_cast<double>(seed % 4)
                                  : drawn_number(seed, 2, -kPi, kPi);
    const OrientedBox a{Vec2(drawn_number(seed, 3, -3, 3), 1), direction_of(angle), Vec2(2.4, 1.0)};
    const OrientedBox b{Vec2(drawn_number(seed, 4, -9, 9), drawn_number(seed, 5, -9, 9)),
                        direction_of(other), Vec2(0.8, 0.5)};
    const ConvexPolygon pa = place_polygon(box_outline(4.8, 2.0), a.forward);
    const ConvexPolygon pb = place_polygon(box_outline(1.6, 1.0), b.forward);
    const PolygonDifference exact = minkowski_difference(pb, pa, b.center - a.center);
    const BoxDifference boxes(b, a);
    const PolygonDifference closed = boxes.polygon();
    for (int k = 0; k < 64; ++k) {
      const Vec2 direction = direction_of(k * kPi / 32 + 0.003);
      EXPECT_NEAR(support(closed, direction), support(exact, direction), 1e-9);
    }
    const NearSide quick = boxes.near_side(), slow = near_side(exact);
    ASSERT_EQ(quick.inside, slow.inside);
    const double depth = overlap_depth(pa, pb, b.center - a.center);
    if (separation(a, b) < 0) {
      EXPECT_NEAR(separation(a, b), -depth, 1e-9);
    }
    EXPECT_EQ(separation(a, b) < 0, depth > 0);
    if (quick.inside) continue;
    EXPECT_NEAR((quick.vertices[0] - slow.vertices[0]).norm(), 0, 1e-9);
    EXPECT_NEAR((quick.vertices[quick.edges] - slow.vertices[slow.edges]).norm(), 0, 1e-9);
    for (std::uint32_t k = 0; k < quick.edges; ++k)
      EXPECT_NEAR(quick.heights[k], quick.normals[k].dot(quick.vertices[k]), 1e-9);
  }
}

TEST(BoxDifference, TellsWhoStaysApart) {
  const OrientedBox a{Vec2(0, 0), Vec2(1, 0), Vec2(2, 1)},
      ahead{Vec2(10, 0), Vec2(1, 0), Vec2(2, 1)};
  const BoxDifference difference(ahead, a);
  EXPECT_TRUE(difference.stays_apart(Vec2(1.4, 5), 4));
  EXPECT_FALSE(difference.stays_apart(Vec2(1.6, 0), 4));
  EXPECT_FALSE(difference.stays_apart(Vec2(1.4, 0), 4, 0.2));
  const BoxDifference overlapping(OrientedBox{Vec2(1, 0.5), Vec2(1, 0), Vec2(2, 1)}, a);
  EXPECT_FALSE(overlapping.stays_apart(Vec2(-9, -9), 4)) << "not even on the way out";
}

TEST(OverlapDepth, IsTheLeastDisplacementThatSeparates) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const ConvexPolygon a = random_polygon(2 * seed), b = random_polygon(2 * seed + 1);
    const Vec2 offset(drawn_number(seed, 7, -3, 3), drawn_number(seed, 8, -3, 3));
    const double depth = overlap_depth(a, b, offset);
    if (depth <= 0) continue;
    // oracle: the smallest shift over many directions after which the supports no longer overlap
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3600; ++k) {
      const Vec2 n = direction_of(k * kPi / 1800);
      least = std::min(least, support(a, n) + support(b, -n) - offset.dot(n));
    }
    EXPECT_LE(depth, least + 1e-9);
    EXPECT_NEAR(depth, least, 0.02);
  }
}

TEST(AsBox, KnowsRectanglesAlongTheAxesOnly) {
  ASSERT_TRUE(as_box(box_outline(4, 2)));
  EXPECT_EQ(as_box(box_outline(4, 2))->half, Vec2(2, 1));
  const std::vector<Vec2> shifted = {{3, -1}, {3, 1}, {-1, 1}, {-1, -1}};
  ASSERT_TRUE(as_box(shifted));
  EXPECT_EQ(as_box(shifted)->center, Vec2(1, 0));
  const std::vector<Vec2> kite = {{2, 0}, {0, 1}, {-2, 0}, {0, -1}},
                          triangle = {{0, 0}, {1, 0}, {0, 1}};
  EXPECT_FALSE(as_box(kite));
  EXPECT_FALSE(as_box(triangle));
  EXPECT_FALSE(as_box(box_outline(4, 0))) << "a segment is no box";
}

TEST(Rotation, IsTheLibrarysToTheLastDigits) {
  for (int k = -70000; k <= 70000; ++k) {
    const double angle = k * 1e-4 + 3e-6;
    const Vec2 turned = rotation(angle);
    ASSERT_NEAR(turned.x(), std::cos(angle), 2e-15) << angle;
    ASSERT_NEAR(turned.y(), std::sin(angle), 2e-15) << angle;
  }
  EXPECT_EQ(rotation(0.0), Vec2(1, 0));
  EXPECT_NEAR(rotation(100.0).x(), std::cos(100.0), 1e-15);
  EXPECT_TRUE(std::isnan(rotation(std::nan("")).x()));
  EXPECT_NEAR(tangent(0.7), std::tan(0.7), 1e-14);
}

}  // namespace
}  // namespace sumogamma
