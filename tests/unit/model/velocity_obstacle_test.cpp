#include "model/velocity_obstacle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/units.h"
#include "geometry/oriented_box.h"
#include "scene/footprint.h"
#include "support/random_draw.h"

namespace sumogamma {
namespace {

ConvexPolygon box(double length, double width, double heading) {
  return place_polygon(box_footprint(length, width).outline(), direction_of(heading));
}

ConvexPolygon octagon(double radius, double phase) {
  std::vector<Vec2> corners;
  for (int k = 0; k < 8; ++k) corners.push_back(radius * direction_of(phase + k * kPi / 4));
  return place_polygon(corners, Vec2(1, 0));
}

/// Eq. 3 by the letter: some t in [0, horizon] brings t * v into B - A. Clips the way travelled by
/// every edge.
bool in_velocity_obstacle(const PolygonDifference& difference, const Vec2& v, double horizon) {
  double from = 0, to = horizon;
  for (std::uint32_t k = 0; k < difference.count; ++k) {
    const double speed = difference.normals[k].dot(v),
                 height = difference.normals[k].dot(difference.vertices[k]);
    if (std::abs(speed) < 1e-15) {
      if (height < 0) return false;
    } else if (speed > 0) {
      to = std::min(to, height / speed);
    } else {
      from = std::max(from, height / speed);
    }
  }
  return from <= to;
}

struct Encounter {
  PolygonDifference difference;
  Vec2 relative;
  double horizon;
};

std::optional<Encounter> random_encounter(std::uint64_t seed) {
  const ConvexPolygon a = box(drawn_number(seed, 1, 0.2, 5), drawn_number(seed, 2, 0.2, 2.5),
                              drawn_number(seed, 3, -kPi, kPi));
  const ConvexPolygon b = box(drawn_number(seed, 4, 0.2, 5), drawn_number(seed, 5, 0.2, 2.5),
                              drawn_number(seed, 6, -kPi, kPi));
  const Vec2 offset(drawn_number(seed, 7, -15, 15), drawn_number(seed, 8, -15, 15));
  if (overlap_depth(a, b, offset) > 0) return std::nullopt;
  return Encounter{minkowski_difference(b, a, offset),
                   Vec2(drawn_number(seed, 9, -8, 8), drawn_number(seed, 10, -8, 8)),
                   drawn_number(seed, 11, 1, 5)};
}

TEST(VelocityObstacle, EscapeReachesTheBoundaryOnTheShortestWay) {
  int inside = 0, outside = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(seed);
    const auto encounter = random_encounter(seed);
    if (!encounter) continue;
    const auto& [difference, v, horizon] = *encounter;
    const Escape escape = nearest_escape(near_side(difference), v, horizon);
    const double distance = escape.change.norm();
    if (distance < 1e-6) continue;
    const bool colliding = in_velocity_obstacle(difference, v, horizon);
    EXPECT_EQ(escape.colliding, colliding);
    (colliding ? inside : outside) += 1;
    EXPECT_NEAR(escape.normal.norm(), 1.0, 1e-9);
    EXPECT_NEAR(cross(escape.change, escape.normal), 0.0, 1e-6);
    EXPECT_EQ(escape.change.dot(escape.normal) > 0, colliding);
    // on the boundary: just short of it and just beyond differ
    EXPECT_NE(in_velocity_obstacle(difference, v + 0.99 * escape.change, horizon),
              in_velocity_obstacle(difference, v + 1.01 * escape.change, horizon));
    // nothing nearer changes sides
    for (int k = 0; k < 72; ++k)
      EXPECT_EQ(in_velocity_obstacle(difference, v + 0.98 * distance * direction_of(k * kPi / 36),
                                     horizon),
                colliding);
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(outside, 50);
}

TEST(VelocityObstacle, SafeVelocitiesNeverCollideWhateverPartTheyLeaveThrough) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    const auto encounter = random_encounter(seed);
    if (!encounter) continue;
    const auto& [difference, v, horizon] = *encounter;
    const Vec2 intended(drawn_number(seed, 21, -8, 8), drawn_number(seed, 22, -8, 8));
    const Escape escape = intended_escape(near_side(difference), v, intended, horizon);
    // anywhere on the free side of the line is outside the obstacle
    for (int k = 0; k < 20; ++k) {
      const Vec2 free =
          v + escape.change +
          drawn_number(seed, 30 + static_cast<std::uint64_t>(k), 0.01, 5) * escape.normal +
          drawn_number(seed, 60 + static_cast<std::uint64_t>(k), -9, 9) * left_of(escape.normal);
      EXPECT_FALSE(in_velocity_obstacle(difference, free, horizon));
    }
  }
}

/// Closed-form ORCA for discs (van den Berg et al. 2011): nearest boundary point of the truncated
/// cone.
Escape disc_escape(const Vec2& offset, double radius, const Vec2& v, double horizon) {
  const Vec2 w = v - offset / horizon;
  const double dot = w.dot(offset);
  Escape escape;
  if (dot < 0 && dot * dot > radius * radius * w.squaredNorm()) {
    escape.normal = w.normalized();
    escape.change = (radius / horizon - w.norm()) * escape.normal;
  } else {
    const double leg = std::sqrt(offset.squaredNorm() - radius * radius);
    const Vec2 left =
        Vec2(offset.x() * leg - offset.y() * radius, offset.x() * radius + offset.y() * leg) /
        offset.squaredNorm();
    const Vec2 right =
        Vec2(offset.x() * leg + offset.y() * radius, -offset.x() * radius + offset.y() * leg) /
        offset.squaredNorm();
    const bool to_left = cross(offset, w) > 0;
    escape.normal = to_left ? left_of(left) : Vec2(-left_of(right));
    escape.change = -escape.normal.dot(v) * escape.normal;
  }
  escape.colliding = escape.change.dot(escape.normal) > 0;
  return escape;
}

TEST(VelocityObstacle, RoundFootprintsReproduceClosedFormOrca) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    // the sum of an octagon and one turned by half a corner is a regular 16-gon: within 1 % of a
    // disc
    const double size = drawn_number(seed, 1, 0.3, 2);
    const PolygonDifference difference =
        minkowski_difference(octagon(size, 0), octagon(size, kPi / 8),
                             Vec2(drawn_number(seed, 7, 5, 12), drawn_number(seed, 8, -3, 3)));
    const Vec2 offset(drawn_number(seed, 7, 5, 12), drawn_number(seed, 8, -3, 3));
    const double radius = 2 * size * std::cos(kPi / 16) * std::cos(kPi / 16);
    const Vec2 v(drawn_number(seed, 9, -2, 5), drawn_number(seed, 10, -3, 3));
    const double horizon = drawn_number(seed, 11, 2, 5);
    const Escape polygon = nearest_escape(near_side(difference), v, horizon),
                 disc = disc_escape(offset, radius, v, horizon);
    EXPECT_NEAR(polygon.change.norm(), disc.change.norm(), 0.05 * size / 2 + 0.02);
    if (disc.change.norm() < 0.1) continue;
    EXPECT_EQ(polygon.colliding, disc.colliding);
    EXPECT_GT(polygon.normal.dot(disc.normal), disc.colliding ? 0.9 : 0.7);
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

TEST(VelocityObstacle, HeadOnPassesOnTheGivenSide) {
  //   A ->        <- B
  const PolygonDifference difference =
      minkowski_difference(box(4, 2, kPi), box(4, 2, 0), Vec2(20, 0));
  const NearSide near = near_side(difference);
  EXPECT_LT(nearest_escape(near, Vec2(8, 0), 4, PassingSide::Right).normal.y(), -0.5);
  EXPECT_GT(nearest_escape(near, Vec2(8, 0), 4, PassingSide::Left).normal.y(), 0.5);
}

TEST(VelocityObstacle, StandingFaceToFaceTheIntentionDecides) {
  const NearSide near = near_side(minkowski_difference(box(4, 2, kPi), box(4, 2, 0), Vec2(10, 0)));
  // nearest to standing is to stay back; nearest to going on is to pass
  EXPECT_NEAR(nearest_escape(near, Vec2(2, 0), 4).normal.x(), -1.0, 1e-9);
  EXPECT_LT(intended_escape(near, Vec2(2, 0), Vec2(8, 0), 4).normal.y(), -0.5);
}

TEST(VelocityObstacle, OverlapComesApartThroughTheNearestEdgeInTheGivenTime) {
  // side by side, half a metre deep
  const PolygonDifference difference =
      minkowski_difference(box(4, 2, 0), box(4, 2, 0), Vec2(0.3, 1.5));
  EXPECT_TRUE(near_side(difference).inside);
  const Escape escape = overlap_escape(difference, Vec2(0, 0), 0.5);
  EXPECT_TRUE(escape.overlapping);
  EXPECT_NEAR(escape.normal.y(), -1.0, 1e-9);
  EXPECT_NEAR(escape.change.y(), -1.0, 1e-9);
  // fast enough already: no more is asked
  EXPECT_FALSE(overlap_escape(difference, Vec2(0, -2), 0.5).colliding);
}

TEST(VelocityObstacle, DegenerateBodiesGiveFiniteAnswers) {
  const std::vector<Vec2> dot = {{0, 0}}, line = {{-1, 0}, {1, 0}};
  const ConvexPolygon point = place_polygon(dot, Vec2(1, 0)),
                      segment = place_polygon(line, Vec2(1, 0));
  for (const Vec2& offset : {Vec2(0, 0), Vec2(3, 0), Vec2(0, 2), Vec2(1e6, 1e6), Vec2(1e-12, 0)})
    for (const ConvexPolygon* a : {&point, &segment})
      for (const ConvexPolygon* b : {&point, &segment}) {
        const PolygonDifference difference = minkowski_difference(*b, *a, offset);
        const NearSide near = near_side(difference);
        for (const Vec2& v : {Vec2(0, 0), Vec2(1, 0), Vec2(-1, 3)}) {
          const Escape escape =
              near.inside ? overlap_escape(difference, v, 0.5) : nearest_escape(near, v, 4);
          EXPECT_TRUE(escape.change.allFinite());
          EXPECT_NEAR(escape.normal.norm(), 1, 1e-9);
        }
      }
}

}  // namespace
}  // namespace sumogamma
