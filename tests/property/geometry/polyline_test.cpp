#include "geometry/polyline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "support/random_draw.h"

namespace sumogamma {
namespace {

/// A line that winds, with pieces from millimetres to a hundred metres.
std::vector<Vec2> winding_line(std::uint64_t seed, std::size_t count) {
  std::vector<Vec2> points{{drawn_number(seed, 0, -1e4, 1e4), drawn_number(seed, 1, -1e4, 1e4)}};
  double heading = 0.0;
  for (std::size_t i = 1; i < count; ++i) {
    heading += drawn_number(seed, 3 * i, -1.0, 1.0);
    const double length = std::pow(10.0, drawn_number(seed, 3 * i + 1, -3.0, 2.0));
    points.push_back(points.back() + length * Vec2(std::cos(heading), std::sin(heading)));
  }
  return points;
}

std::size_t segment_by_search(const Polyline& line, double along) {
  std::size_t i = 0;
  while (i + 2 < line.points().size() && line.along_of_vertex(i + 1) <= along) ++i;
  return i;
}

/// The nearest point among the segments from `first` to `last`, each looked at.
PolylinePosition project_by_search(const Polyline& line, const Vec2& point, std::size_t first,
                                   std::size_t last) {
  PolylinePosition best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i <= last; ++i) {
    const double span = line.along_of_vertex(i + 1) - line.along_of_vertex(i);
    const Vec2 forward = (line.points()[i + 1] - line.points()[i]) / span;
    const Vec2 relative = point - line.points()[i];
    const double t = std::clamp(relative.dot(forward), 0.0, span);
    const double distance = (relative - t * forward).norm();
    if (distance >= best.distance) continue;
    best = {line.along_of_vertex(i) + t, cross(forward, relative) >= 0.0 ? distance : -distance,
            distance, i};
  }
  return best;
}

TEST(PolylineLaws, SegmentsAreThoseThatASearchFinds) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const Polyline line(winding_line(seed, 2 + seed));
    for (std::size_t i = 0; i < line.points().size(); ++i)
      for (const double beside : {-1e-9, 0.0, 1e-9, 0.3}) {
        const double along = line.along_of_vertex(i) + beside;
        ASSERT_EQ(line.segment_at(along), segment_by_search(line, along)) << along;
      }
    EXPECT_EQ(line.segment_at(std::nan("")), line.points().size() - 2);
  }
}

// the same bits, not about the same
TEST(PolylineLaws, ProjectionsAreThoseThatASearchFinds) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const Polyline line(winding_line(seed, 2 + seed));
    for (std::uint64_t k = 0; k < 50; ++k) {
      const double along = drawn_number(seed, 10 * k, -20.0, line.length() + 20.0);
      const double away = std::pow(10.0, drawn_number(seed, 10 * k + 1, -9.0, 3.0));
      const Vec2 point = line.point_at(along) + away * Vec2(drawn_number(seed, 10 * k + 2, -1, 1),
                                                            drawn_number(seed, 10 * k + 3, -1, 1));
      const double from = drawn_number(seed, 10 * k + 4, -50.0, line.length() + 50.0);
      const double to = from + drawn_number(seed, 10 * k + 5, 0.0, 200.0);
      const PolylinePosition found = line.project(point, from, to);
      const PolylinePosition searched = project_by_search(
          line, point, segment_by_search(line, from), segment_by_search(line, to));
      ASSERT_EQ(found.segment, searched.segment) << k;
      ASSERT_EQ(found.along, searched.along) << k;
      ASSERT_EQ(found.offset, searched.offset) << k;
      ASSERT_EQ(found.distance, searched.distance) << k;
      ASSERT_EQ(line.project(point).along,
                project_by_search(line, point, 0, line.points().size() - 2).along);
    }
  }
}

}  // namespace
}  // namespace sumogamma
