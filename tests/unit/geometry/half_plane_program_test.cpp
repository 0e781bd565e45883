#include "geometry/half_plane_program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "support/random_draw.h"

namespace sumogamma {
namespace {

struct Case {
  std::vector<HalfPlane> planes;
  std::size_t hard = 0;
  Vec2 target;
};

/// Hard planes admit the null vector; soft ones anything.
Case random_case(std::uint64_t seed) {
  Case c;
  c.hard = random_bits(seed, 0, 1, Draw::ProcessNoise) % 5;
  const std::size_t soft = random_bits(seed, 0, 2, Draw::ProcessNoise) % 10;
  for (std::size_t k = 0; k < c.hard + soft; ++k) {
    const Vec2 normal = direction_of(drawn_number(seed, 10 + k, -kPi, kPi));
    const double offset =
        k < c.hard ? drawn_number(seed, 40 + k, -4, 0) : drawn_number(seed, 40 + k, -4, 3);
    c.planes.push_back({offset * normal, normal});
  }
  c.target = {drawn_number(seed, 80, -6, 6), drawn_number(seed, 81, -6, 6)};
  return c;
}

constexpr double kRadius = 5.0;

double worst_violation(const Case& c, std::size_t from, std::size_t to, const Vec2& v) {
  double worst = 0;
  for (std::size_t k = from; k < to; ++k) worst = std::max(worst, -slack(c.planes[k], v));
  return worst;
}

/// All points where an optimum can lie: the target, its feet on the lines, crossings of lines, of
/// lines and the circle, and the target's foot on the circle.
std::vector<Vec2> candidates(const std::vector<HalfPlane>& planes, const Vec2& target) {
  std::vector<Vec2> points = {target};
  if (target.norm() > kRadius) points.push_back(target * (kRadius / target.norm()));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Vec2& n = planes[i].normal;
    const double d = planes[i].point.dot(n);
    points.push_back(target - (target.dot(n) - d) * n);
    if (kRadius * kRadius > d * d)
      for (double sign : {-1.0, 1.0})
        points.push_back(d * n + sign * std::sqrt(kRadius * kRadius - d * d) * left_of(n));
    for (std::size_t j = 0; j < i; ++j) {
      const Vec2& m = planes[j].normal;
      const double e = planes[j].point.dot(m), det = cross(n, m);
      if (std::abs(det) > 1e-9)
        points.push_back(Vec2(d * m.y() - e * n.y(), e * n.x() - d * m.x()) / det);
    }
  }
  return points;
}

double brute_force_distance(const Case& c) {
  double best = std::numeric_limits<double>::infinity();
  for (const Vec2& p : candidates(c.planes, c.target))
    if (p.norm() <= kRadius + 1e-9 && worst_violation(c, 0, c.planes.size(), p) <= 1e-9)
      best = std::min(best, (p - c.target).norm());
  return best;
}

TEST(HalfPlaneProgram, FindsTheNearestPointOfABruteForceSearch) {
  ProgramScratch scratch;
  int feasible = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    SCOPED_TRACE(seed);
    const Case c = random_case(seed);
    const ProgramResult result = closest_point(c.planes, c.hard, c.target, kRadius, scratch);
    const double oracle = brute_force_distance(c);
    EXPECT_EQ(result.violation == 0, std::isfinite(oracle));
    if (!std::isfinite(oracle)) continue;
    ++feasible;
    EXPECT_NEAR((result.point - c.target).norm(), oracle, 1e-7);
    EXPECT_LE(worst_violation(c, 0, c.planes.size(), result.point), 1e-9);
    if (result.binding >= 0) {
      EXPECT_NEAR(slack(c.planes[static_cast<std::size_t>(result.binding)], result.point), 0, 1e-9);
    }
  }
  EXPECT_GT(feasible, 500);
}

TEST(HalfPlaneProgram, ViolatesSoftPlanesTheLeastWithTheHardOnesKept) {
  ProgramScratch scratch;
  int infeasible = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    const Case c = random_case(seed);
    const ProgramResult result = closest_point(c.planes, c.hard, c.target, kRadius, scratch);
    if (result.violation == 0) continue;
    ++infeasible;
    EXPECT_LE(worst_violation(c, 0, c.hard, result.point), 1e-9);
    EXPECT_LE(result.point.norm(), kRadius + 1e-9);
    // oracle: a fine grid over the disc
    double least = std::numeric_limits<double>::infinity();
    for (double x = -kRadius; x <= kRadius; x += 0.05)
      for (double y = -kRadius; y <= kRadius; y += 0.05) {
        const Vec2 v(x, y);
        if (v.norm() <= kRadius && worst_violation(c, 0, c.hard, v) <= 0)
          least = std::min(least, worst_violation(c, c.hard, c.planes.size(), v));
      }
    const double own = worst_violation(c, c.hard, c.planes.size(), result.point);
    EXPECT_LE(own, least + 0.01 + 1e-6) << "within a centimetre a second of the least";
    EXPECT_LE(result.violation, least + 1e-6);
  }
  EXPECT_GT(infeasible, 300);
}

TEST(HalfPlaneProgram, MovesContinuouslyWithItsInput) {
  ProgramScratch scratch;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(seed);
    Case c = random_case(seed);
    const Vec2 before = closest_point(c.planes, c.hard, c.target, kRadius, scratch).point;
    for (std::size_t k = 0; k < c.planes.size(); ++k)
      c.planes[k].point +=
          (k < c.hard ? -1e-7 : 1e-7 * (k % 2 == 0 ? 1.0 : -1.0)) * c.planes[k].normal;
    const Vec2 after = closest_point(c.planes, c.hard, c.target, kRadius, scratch).point;
    EXPECT_LE((after - before).norm(), 1e-3);
  }
}

TEST(HalfPlaneProgram, OppositeSoftPlanesMeetInTheMiddleNearestToTheTarget) {
  //  n: -> wants x >= 2, <- wants x <= -2: the middle is x = 0, and y follows the target
  const std::vector<HalfPlane> planes = {{Vec2(2, 0), Vec2(1, 0)}, {Vec2(-2, 0), Vec2(-1, 0)}};
  ProgramScratch scratch;
  const ProgramResult result = closest_point(planes, 0, Vec2(0, 1.5), kRadius, scratch);
  EXPECT_NEAR(result.violation, 2.0, 1e-9);
  EXPECT_NEAR(result.point.x(), 0.0, 0.011);
  EXPECT_NEAR(result.point.y(), 1.5, 1e-9);
}

TEST(HalfPlaneProgram, NothingMakesItNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInf = std::numeric_limits<double>::infinity();
  ProgramScratch scratch;
  const std::vector<HalfPlane> odd = {{Vec2(kNan, 0), Vec2(1, 0)},
                                      {Vec2(0, 0), Vec2(kNan, kNan)},
                                      {Vec2(kInf, 0), Vec2(-1, 0)},
                                      {Vec2(1, 1), Vec2(0, 0)},
                                      {Vec2(1e300, 0), Vec2(1, 0)}};
  for (const Vec2& target : {Vec2(1, 2), Vec2(kNan, 0), Vec2(kInf, -kInf), Vec2(1e300, 1e300)})
    for (double radius : {5.0, 0.0, -1.0, kNan, kInf})
      for (std::size_t hard : {std::size_t{0}, std::size_t{2}, odd.size()})
        EXPECT_TRUE(closest_point(odd, hard, target, radius, scratch).point.allFinite());
  EXPECT_EQ(closest_point({}, 0, Vec2(1, 2), kRadius, scratch).point, Vec2(1, 2));
  EXPECT_EQ(closest_point({}, 0, Vec2(10, 0), kRadius, scratch).point, Vec2(5, 0));
}

TEST(HalfPlaneProgram, HardPlanesThatMeetInTheNullVectorAloneGiveIt) {
  const std::vector<HalfPlane> planes = {{Vec2(0, 0), Vec2(1, 0)},
                                         {Vec2(0, 0), Vec2(-0.5, 0.8660254037844386)},
                                         {Vec2(0, 0), Vec2(-0.5, -0.8660254037844386)}};
  ProgramScratch scratch;
  EXPECT_NEAR(closest_point(planes, 3, Vec2(3, 1), kRadius, scratch).point.norm(), 0, 1e-12);
}

}  // namespace
}  // namespace sumogamma
