#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// Where a point lies relative to a polyline.
struct PolylinePosition {
  double along = 0;     ///< [m] from the start, within [0, length]
  double offset = 0;    ///< signed distance [m], positive to the left of the direction of travel
  double distance = 0;  ///< distance to the nearest point [m]; equals |offset| but beyond the ends
  std::size_t segment = 0;
};

/// An immutable open chain of at least one point with its arc length. Consecutive duplicates are
/// dropped.
class Polyline {
 public:
  Polyline() = default;
  explicit Polyline(const std::vector<Vec2>& points);

  const std::vector<Vec2>& points() const { return points_; }
  bool empty() const { return points_.empty(); }
  double length() const { return along_.empty() ? 0.0 : along_.back(); }
  double along_of_vertex(std::size_t index) const { return along_[index]; }

  /// Index of the segment that holds `along` (clamped to the line).
  std::size_t segment_at(double along) const;
  /// Point at `along` [m], clamped to the ends.
  Vec2 point_at(double along) const;
  /// Unit direction of travel at `along`; (1,0) for a single point.
  Vec2 direction_at(double along) const;

  /// Nearest point of the whole line.
  PolylinePosition project(const Vec2& point) const;
  /// Nearest point among the segments that meet [from, to] [m]: follows one's own path where it
  /// crosses itself.
  PolylinePosition project(const Vec2& point, double from, double to) const;
  /// The same where that is within `most` [m]; else somewhere farther away, or at an infinite
  /// distance. Much cheaper for what is far off.
  PolylinePosition project_near(const Vec2& point, double from, double to, double most) const;

 private:
  PolylinePosition project_segments(const Vec2& point, std::size_t first, std::size_t last,
                                    double most) const;
  void index_segments();

  std::vector<Vec2> points_;
  std::vector<double> along_;
  /// Segment that holds the begin of each of as many equal parts of a long line as it has segments.
  std::vector<std::uint32_t> segment_of_part_;
  double parts_per_metre_ = 0;
};

}  // namespace sumogamma
