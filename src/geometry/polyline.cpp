#include "geometry/polyline.h"

#include <algorithm>
#include <limits>

namespace sumogamma {

Polyline::Polyline(const std::vector<Vec2>& points) {
  constexpr double kShortest = 1e-6;
  points_.reserve(points.size());
  for (const Vec2& point : points) {
    if (!points_.empty() && (point - points_.back()).norm() < kShortest) continue;
    along_.push_back(points_.empty() ? 0.0 : along_.back() + (point - points_.back()).norm());
    points_.push_back(point);
  }
}

std::size_t Polyline::segment_at(double along) const {
  if (points_.size() < 2) return 0;
  const auto after = std::upper_bound(along_.begin(), along_.end(), along);
  const auto index =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - along_.begin() - 1, 0));
  return std::min(index, points_.size() - 2);
}

Vec2 Polyline::point_at(double along) const {
  if (points_.empty()) return Vec2::Zero();
  if (points_.size() == 1) return points_.front();
  const std::size_t i = segment_at(along);
  const double span = along_[i + 1] - along_[i];
  const double t = std::clamp((along - along_[i]) / span, 0.0, 1.0);
  return points_[i] + t * (points_[i + 1] - points_[i]);
}

Vec2 Polyline::direction_at(double along) const {
  if (points_.size() < 2) return Vec2(1, 0);
  const std::size_t i = segment_at(along);
  return (points_[i + 1] - points_[i]) / (along_[i + 1] - along_[i]);
}

PolylinePosition Polyline::project(const Vec2& point) const {
  return project_segments(point, 0, points_.size() < 2 ? 0 : points_.size() - 2);
}

PolylinePosition Polyline::project(const Vec2& point, double from, double to) const {
  return project_segments(point, segment_at(from), segment_at(to));
}

PolylinePosition Polyline::project_segments(const Vec2& point, std::size_t first,
                                            std::size_t last) const {
  PolylinePosition best;
  if (points_.empty()) return best;
  if (points_.size() == 1) {
    best.distance = (point - points_.front()).norm();
    return best;
  }
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i <= last; ++i) {
    const Vec2 edge = points_[i + 1] - points_[i];
    const double span = along_[i + 1] - along_[i];
    const Vec2 forward = edge / span;
    const Vec2 relative = point - points_[i];
    const double t = std::clamp(relative.dot(forward), 0.0, span);
    const double distance = (relative - t * forward).norm();
    if (distance < best.distance) {
      best.distance = distance;
      best.along = along_[i] + t;
      best.segment = i;
      best.offset = cross(forward, relative) >= 0.0 ? distance : -distance;
    }
  }
  return best;
}

}  // namespace sumogamma
