#include "geometry/polyline.h"

#include <algorithm>
#include <limits>

namespace sumogamma {

namespace {
constexpr double kAnywhere = std::numeric_limits<double>::infinity();
}

Polyline::Polyline(const std::vector<Vec2>& points) {
  constexpr double kShortest = 1e-6;
  points_.reserve(points.size());
  along_.reserve(points.size());
  for (const Vec2& point : points) {
    if (!points_.empty() && (point - points_.back()).norm() < kShortest) continue;
    along_.push_back(points_.empty() ? 0.0 : along_.back() + (point - points_.back()).norm());
    points_.push_back(point);
  }
  index_segments();
}

void Polyline::index_segments() {
  constexpr std::size_t kFew = 8;  // segments, which are looked through one by one
  if (points_.size() <= kFew + 1) return;
  const std::size_t count = points_.size() - 1;
  segment_of_part_.resize(count);
  parts_per_metre_ = static_cast<double>(count) / length();
  std::size_t segment = 0;
  for (std::size_t part = 0; part < count; ++part) {
    const double begin = static_cast<double>(part) / parts_per_metre_;
    while (segment + 1 < count && along_[segment + 1] <= begin) ++segment;
    segment_of_part_[part] = static_cast<std::uint32_t>(segment);
  }
}

std::size_t Polyline::segment_at(double along) const {
  if (points_.size() < 2 || along <= 0.0) return 0;
  if (!(along < length())) return points_.size() - 2;
  std::size_t i = 0;
  if (!segment_of_part_.empty()) {
    const auto part = static_cast<std::size_t>(along * parts_per_metre_);
    i = segment_of_part_[std::min(part, segment_of_part_.size() - 1)];
    while (along_[i] > along) --i;  // where rounding led into the next part
  }
  while (along_[i + 1] <= along) ++i;
  return i;
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
  return project_segments(point, 0, points_.size() < 2 ? 0 : points_.size() - 2, kAnywhere);
}

PolylinePosition Polyline::project(const Vec2& point, double from, double to) const {
  return project_segments(point, segment_at(from), segment_at(to), kAnywhere);
}

PolylinePosition Polyline::project_near(const Vec2& point, double from, double to,
                                        double most) const {
  return project_segments(point, segment_at(from), segment_at(to), most);
}

PolylinePosition Polyline::project_segments(const Vec2& point, std::size_t first, std::size_t last,
                                            double most) const {
  PolylinePosition best;
  if (points_.empty()) return best;
  if (points_.size() == 1) {
    best.distance = (point - points_.front()).norm();
    return best;
  }
  constexpr double kRounding = 1e-6;  // [m]
  best.distance = kAnywhere;
  for (std::size_t i = first; i <= last; ++i) {
    const Vec2 relative = point - points_[i];
    const double span = along_[i + 1] - along_[i];
    // by the triangle inequality whatever lies on the line before `clear` is farther away
    const double wanted = std::min(best.distance, most);
    const double reach = wanted + span + kRounding;
    if (relative.squaredNorm() > reach * reach) {
      const double clear = along_[i] + relative.norm() - wanted - kRounding;
      while (i < last && along_[i + 2] < clear) ++i;
      continue;
    }
    const Vec2 forward = (points_[i + 1] - points_[i]) / span;
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
