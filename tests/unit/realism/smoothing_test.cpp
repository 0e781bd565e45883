#include "realism/smoothing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sumogamma {
namespace {

Vec2 parabola(double t) { return {1.0 + 2.0 * t - 0.3 * t * t, -4.0 + 0.5 * t * t}; }
Vec2 slope(double t) { return {2.0 - 0.6 * t, t}; }

TEST(Smoothing, LeavesAParabolaAsItIs) {
  for (const double period : {0.1, 0.4}) {
    std::vector<Vec2> points;
    for (int k = 0; k < 24; ++k) points.push_back(parabola(period * k));
    const SmoothedTrack track = smoothed(points, period);
    for (std::size_t k = 0; k < points.size(); ++k) {
      EXPECT_NEAR((track.position[k] - points[k]).norm(), 0.0, 1e-9);
      EXPECT_NEAR((track.velocity[k] - slope(period * static_cast<double>(k))).norm(), 0.0, 1e-9);
    }
  }
}

// eleven points of 0.1 s: the weights of the middle one are those of Savitzky and Golay's table
TEST(Smoothing, HasTheWeightsOfTheTable) {
  std::vector<Vec2> points(41, Vec2::Zero());
  points[20] = {1.0, 0.0};
  const SmoothedTrack track = smoothed(points, 0.1);
  const double weights[] = {89, 84, 69, 44, 9, -36};
  for (std::size_t k = 0; k <= 5; ++k)
    EXPECT_NEAR(track.position[20 + k].x(), weights[k] / 429.0, 1e-9);
  EXPECT_NEAR(track.position[26].x(), 0.0, 1e-12);
}

TEST(Smoothing, TakesWhatThereIsOfAShortTrack) {
  for (const std::size_t count : {3u, 4u, 6u}) {
    std::vector<Vec2> points;
    for (std::size_t k = 0; k < count; ++k) points.emplace_back(static_cast<double>(k), 0.0);
    const SmoothedTrack track = smoothed(points, 0.1);
    for (std::size_t k = 0; k < count; ++k) EXPECT_NEAR(track.velocity[k].x(), 10.0, 1e-9);
  }
}

TEST(Smoothing, ValueAndSlopeAtTheEnd) {
  std::vector<double> times;
  std::vector<Vec2> values;
  for (int k = 0; k <= 10; ++k) {
    times.push_back(-1.0 + 0.1 * k);
    values.push_back(parabola(times.back()));
  }
  const auto [value, rate] = value_and_slope(times, values);
  EXPECT_NEAR((value - parabola(0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((rate - slope(0)).norm(), 0.0, 1e-9);
  // a line through three
  const std::vector<double> few{-0.8, -0.4, 0.0};
  const std::vector<Vec2> line{{0, 0}, {2, 0}, {4, 0}};
  EXPECT_NEAR(value_and_slope(few, line).second.x(), 5.0, 1e-9);
  EXPECT_EQ(value_and_slope(std::vector{-0.2}, std::vector{Vec2(3, 4)}).second.norm(), 0.0);
}

}  // namespace
}  // namespace sumogamma
