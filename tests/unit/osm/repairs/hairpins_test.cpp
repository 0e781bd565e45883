#include "osm/repairs/hairpins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace sumogamma::osm {
namespace {

constexpr double kBulb = 7.0;  // [m]

/// A line through corners, with points 1.5 m apart.
std::vector<Vec2> drawn(const std::vector<Vec2>& corners) {
  std::vector<Vec2> points{corners[0]};
  for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
    const double pieces = std::round((corners[c + 1] - corners[c]).norm() / 1.5);
    for (double k = 1; k <= pieces; ++k)
      points.emplace_back(corners[c] + (corners[c + 1] - corners[c]) * (k / pieces));
  }
  return points;
}

std::vector<Vec2> opened(const std::vector<Vec2>& points) {
  return open_hairpins(points, std::vector<double>(points.size(), 15.0), kBulb);
}

/// Narrowest and widest distance from the x axis of the points between two places on it [m].
std::pair<double, double> width_between(const std::vector<Vec2>& points, double from, double to) {
  double least = 1e9, most = 0;
  for (const Vec2& point : points) {
    if (point.x() < from || point.x() > to) continue;
    least = std::min(least, std::abs(point.y()));
    most = std::max(most, std::abs(point.y()));
  }
  return {least, most};
}

/*           .-- (80, 10)
     (0, 0) <                 a V of 14 degrees
             '-- (80, -10)                        */
TEST(OpenHairpins, AVBecomesABulbThroughItsTip) {
  const std::vector<Vec2> v = drawn({{80, 10}, {0, 0}, {80, -10}});
  const std::vector<Vec2> bulb = opened(v);
  const std::size_t tip = v.size() / 2;
  EXPECT_EQ(bulb[tip], v[tip]);
  const auto [least, most] = width_between(bulb, 5, 9);
  EXPECT_GT(least, 6.4);
  EXPECT_LT(most, 7.01);
  for (std::size_t i = 0; i < v.size(); ++i) {
    EXPECT_NEAR(bulb[i].x(), v[i].x(), 1e-9) << "points move away from the axis alone";
    EXPECT_EQ(bulb[i].y() > 0.0, v[i].y() > 0.0) << "and to their own side";
    if (v[i].x() > 37.0) {
      EXPECT_EQ(bulb[i], v[i]) << "the road beyond stays";
    }
  }
}

// the second arm leaves the tip on the first one's side
TEST(OpenHairpins, ArmsThatCrossNearTheTipArePartedToWhereTheyGo) {
  const std::vector<Vec2> bulb = opened(drawn({{60, 12}, {8, -1}, {0, 0}, {8, 1}, {60, -12}}));
  const std::size_t half = bulb.size() / 2;
  for (std::size_t i = 1; i < half; ++i) {
    EXPECT_GE(bulb[i].y(), -1e-9);
    EXPECT_LE(bulb[bulb.size() - 1 - i].y(), 1e-9);
  }
}

// it comes by the tip again on its way down the hill
TEST(OpenHairpins, TheRoadFurtherOnStays) {
  const std::vector<Vec2> v =
      drawn({{90, 4}, {0, 0}, {60, -4}, {60, -40}, {10, -40}, {10, -60}, {10, 80}});
  const std::vector<Vec2> bulb = opened(v);
  for (std::size_t i = v.size() - 60; i < v.size(); ++i) EXPECT_EQ(bulb[i], v[i]);
}

TEST(OpenHairpins, WideOnesRightAnglesAndFixedPointsStay) {
  std::vector<Vec2> wide;
  for (double angle = -90; angle <= 90; angle += 5)
    wide.emplace_back(-9.0 * std::cos(angle * kPi / 180), 9.0 * std::sin(angle * kPi / 180));
  EXPECT_EQ(opened(wide), wide);
  const std::vector<Vec2> corner = drawn({{50, 0}, {0, 0}, {0, 50}});
  EXPECT_EQ(opened(corner), corner);
  const std::vector<Vec2> v = drawn({{80, 10}, {0, 0}, {80, -10}});
  EXPECT_EQ(open_hairpins(v, std::vector<double>(v.size(), 0.0), kBulb), v);
  EXPECT_TRUE(opened({}).empty());
}

}  // namespace
}  // namespace sumogamma::osm
