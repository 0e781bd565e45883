#include "geometry/spatial_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/random.h"

namespace sumogamma {
namespace {

std::vector<std::uint32_t> within(const SpatialGrid& grid, const Vec2& center, double radius) {
  std::vector<std::uint32_t> rows;
  grid.visit_within(center, radius, [&](std::uint32_t row, double) { rows.push_back(row); });
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::vector<std::uint32_t> brute_force(const std::vector<Vec2>& points, const Vec2& center,
                                       double radius) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < points.size(); ++row)
    if ((points[row] - center).squaredNorm() <= radius * radius) rows.push_back(row);
  return rows;
}

std::vector<Vec2> scatter(std::uint64_t seed, std::size_t count, double extent,
                          const Vec2& origin) {
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < count; ++k)
    points.push_back(origin + Vec2(random_uniform(seed, k, 0, Draw::ProcessNoise, 0, extent),
                                   random_uniform(seed, k, 1, Draw::ProcessNoise, 0, extent)));
  return points;
}

TEST(SpatialGrid, FindsWhatABruteForceSearchFinds) {
  SpatialGrid grid;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const double extent = seed % 3 == 0 ? 5.0 : 50.0 * static_cast<double>(seed);
    const Vec2 origin = seed % 2 == 0 ? Vec2(1e6, -1e6) : Vec2(0, 0);
    std::vector<Vec2> points = scatter(seed, 300, extent, origin);
    points.push_back(origin + Vec2(1e5, 3e5));  // somebody far away from all
    grid.rebuild(points);
    for (std::size_t k = 0; k < points.size(); k += 10)
      for (double radius : {0.0, 1.0, 12.0, 90.0, 1e7})
        EXPECT_EQ(within(grid, points[k], radius), brute_force(points, points[k], radius));
  }
}

TEST(SpatialGrid, VisitsRowsInAnOrderThatDoesNotDependOnTheQuery) {
  SpatialGrid grid;
  const std::vector<Vec2> points = scatter(5, 400, 100, Vec2(0, 0));
  grid.rebuild(points);
  std::vector<std::uint32_t> near, far;
  grid.visit_within(points[0], 20, [&](std::uint32_t row, double) { near.push_back(row); });
  grid.visit_within(points[0], 60, [&](std::uint32_t row, double) { far.push_back(row); });
  std::vector<std::uint32_t> common;
  for (std::uint32_t row : far)
    if (std::find(near.begin(), near.end(), row) != near.end()) common.push_back(row);
  EXPECT_EQ(common, near);
}

TEST(SpatialGrid, TakesTenThousandInOnePlaceAndNoneAtAll) {
  SpatialGrid grid;
  grid.rebuild(std::vector<Vec2>(10000, Vec2(3, 4)));
  EXPECT_EQ(within(grid, Vec2(3, 4), 0.1).size(), 10000u);
  EXPECT_TRUE(within(grid, Vec2(30, 4), 0.1).empty());
  grid.rebuild(std::vector<Vec2>{});
  EXPECT_TRUE(within(grid, Vec2(0, 0), 10).empty());
}

TEST(SpatialGrid, IgnoresWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInf = std::numeric_limits<double>::infinity();
  SpatialGrid grid;
  grid.rebuild(std::vector<Vec2>{{kNan, 0}, {0, kInf}, {1, 1}, {-kInf, kNan}});
  EXPECT_EQ(within(grid, Vec2(0, 0), 5), std::vector<std::uint32_t>{2});
  EXPECT_TRUE(within(grid, Vec2(kNan, 0), 5).empty());
  EXPECT_TRUE(within(grid, Vec2(0, 0), kNan).empty());
}

}  // namespace
}  // namespace sumogamma
