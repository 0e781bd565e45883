#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sumogamma {

/// By point of a chain, whether it has to stay so that the line through those that do is nowhere
/// off by more than `tolerance` [m] (Douglas and Peucker, 1973). Points are Eigen vectors of two or
/// three coordinates; both ends stay.
template <typename Point>
std::vector<bool> needed_points(const std::vector<Point>& points, double tolerance) {
  std::vector<bool> needed(points.size(), false);
  if (points.empty()) return needed;
  needed.front() = needed.back() = true;
  const auto mark = [&](const auto& self, std::size_t first, std::size_t last) -> void {
    const Point chord = points[last] - points[first];
    double worst = tolerance;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const Point from_first = points[i] - points[first];
      // a chain may end where it starts
      const double share =
          chord.isZero() ? 0.0 : std::clamp(from_first.dot(chord) / chord.squaredNorm(), 0.0, 1.0);
      const double off = (from_first - share * chord).norm();
      if (off > worst) {
        worst = off;
        at = i;
      }
    }
    if (at == first) return;
    needed[at] = true;
    self(self, first, at);
    self(self, at, last);
  };
  mark(mark, 0, points.size() - 1);
  return needed;
}

}  // namespace sumogamma
