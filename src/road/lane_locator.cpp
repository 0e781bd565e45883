#include "road/lane_locator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "geometry/segment.h"

namespace sumogamma {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

bool ring_contains(std::span<const Vec2> ring, const Vec2& point) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    if ((ring[i].y() > point.y()) == (ring[j].y() > point.y())) continue;
    const double x = ring[i].x() + (point.y() - ring[i].y()) / (ring[j].y() - ring[i].y()) *
                                       (ring[j].x() - ring[i].x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

double distance_to_ring(std::span<const Vec2> ring, const Vec2& point) {
  double nearest = kInfinity;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    nearest = std::min(nearest, distance_to_segment(ring[j], ring[i], point));
  return nearest;
}

double distance_to_area(std::span<const Vec2> ring, const Vec2& point) {
  return ring_contains(ring, point) ? 0.0 : distance_to_ring(ring, point);
}

LaneLocator::LaneLocator(const RoadNetwork& network) : network_(&network) {
  if (network.lanes.empty()) return;
  origin_ = network.lower_corner;
  const Vec2 size = network.upper_corner - network.lower_corner;
  // cells of about a lane's reach, but never so many that the grid outweighs the lanes
  constexpr double kCell = 12.0, kFewCells = 1e5, kMostCells = 4e6, kCellsAPoint = 100.0;
  double points = 0;
  for (const Lane& lane : network.lanes)
    points += static_cast<double>(lane.centerline.points().size());
  const double cells = std::clamp(kCellsAPoint * points, kFewCells, kMostCells);
  cell_ = std::max({kCell, std::sqrt(size.x() * size.y() / cells), size.maxCoeff() / cells});
  columns_ = static_cast<std::size_t>(size.x() / cell_) + 1;
  lines_ = static_cast<std::size_t>(size.y() / cell_) + 1;

  // counting sort in two passes, so that a cell's entries lie together
  entry_begin_.assign(columns_ * lines_ + 1, 0);
  junction_begin_.assign(columns_ * lines_ + 1, 0);
  rasterize([&](std::size_t cell, const Entry&) { ++entry_begin_[cell + 1]; },
            [&](std::size_t cell, JunctionId) { ++junction_begin_[cell + 1]; });
  for (std::size_t cell = 0; cell < columns_ * lines_; ++cell) {
    entry_begin_[cell + 1] += entry_begin_[cell];
    junction_begin_[cell + 1] += junction_begin_[cell];
  }
  entries_.resize(entry_begin_.back());
  junctions_.resize(junction_begin_.back());
  std::vector<std::uint32_t> entry_at(entry_begin_.begin(), entry_begin_.end() - 1);
  std::vector<std::uint32_t> junction_at(junction_begin_.begin(), junction_begin_.end() - 1);
  rasterize([&](std::size_t cell, const Entry& entry) { entries_[entry_at[cell]++] = entry; },
            [&](std::size_t cell, JunctionId id) { junctions_[junction_at[cell]++] = id; });
}

template <typename Visit>
void LaneLocator::visit_cells(const Vec2& lower, const Vec2& upper, Visit&& visit) const {
  auto clamp_to = [](double offset, std::size_t count) {
    return static_cast<std::size_t>(
        std::clamp(std::floor(offset), 0.0, static_cast<double>(count - 1)));
  };
  const std::size_t left = clamp_to((lower.x() - origin_.x()) / cell_, columns_);
  const std::size_t right = clamp_to((upper.x() - origin_.x()) / cell_, columns_);
  const std::size_t bottom = clamp_to((lower.y() - origin_.y()) / cell_, lines_);
  const std::size_t top = clamp_to((upper.y() - origin_.y()) / cell_, lines_);
  for (std::size_t y = bottom; y <= top; ++y)
    for (std::size_t x = left; x <= right; ++x) visit(y * columns_ + x);
}

LaneLocator::Box LaneLocator::box_about(const Vec2& lower, const Vec2& upper) const {
  constexpr double kRounding = 0.1;  // of floats, and some [m]
  const Vec2 low = lower - origin_ - Vec2::Constant(kRounding);
  const Vec2 high = upper - origin_ + Vec2::Constant(kRounding);
  return {static_cast<float>(low.x()), static_cast<float>(low.y()), static_cast<float>(high.x()),
          static_cast<float>(high.y())};
}

/// Calls add_entry(cell, entry) for each lane and cell that it may touch, lanes in order of id, and
/// add_junction likewise.
template <typename AddEntry, typename AddJunction>
void LaneLocator::rasterize(AddEntry&& add_entry, AddJunction&& add_junction) const {
  auto bounds = [](std::span<const Vec2> points, double margin) {
    Vec2 lower(kInfinity, kInfinity), upper(-kInfinity, -kInfinity);
    for (const Vec2& point : points) {
      lower = lower.cwiseMin(point);
      upper = upper.cwiseMax(point);
    }
    return std::pair<Vec2, Vec2>(lower - Vec2(margin, margin), upper + Vec2(margin, margin));
  };
  const auto reach = [](const Lane& lane) { return 0.5 * lane.width + kEndTolerance; };
  std::vector<std::pair<std::size_t, std::uint32_t>> touched;  // (cell, segment)
  for (std::size_t index = 0; index < network_->lanes.size(); ++index) {
    const Lane& lane = network_->lanes[index];
    const LaneId id{static_cast<std::int32_t>(index)};
    const std::vector<Vec2>& points = lane.centerline.points();
    if (lane.kind == LaneKind::WalkingArea) {
      const auto [lower, upper] = bounds(lane.outline, 0.0);
      const Entry entry{id, 0, 0, box_about(lower, upper)};
      visit_cells(lower, upper, [&](std::size_t cell) { add_entry(cell, entry); });
      continue;
    }
    touched.clear();
    for (std::uint32_t segment = 0; segment + 1 < points.size(); ++segment) {
      // piece by piece: a long diagonal touches few of the cells that lie in the box about it
      const Vec2 &begin = points[segment], along = points[segment + 1] - begin;
      const double pieces = std::max(1.0, std::ceil(along.norm() / cell_));
      for (double piece = 0; piece < pieces; ++piece) {
        const std::array<Vec2, 2> ends{begin + (piece / pieces) * along,
                                       begin + ((piece + 1) / pieces) * along};
        const auto [lower, upper] = bounds(ends, reach(lane));
        visit_cells(lower, upper, [&](std::size_t cell) { touched.emplace_back(cell, segment); });
      }
    }
    std::sort(touched.begin(), touched.end());
    for (std::size_t i = 0; i < touched.size();) {
      std::size_t end = i;
      while (end < touched.size() && touched[end].first == touched[i].first) ++end;
      const std::uint32_t first = touched[i].second, last = touched[end - 1].second;
      const auto [lower, upper] =
          bounds(std::span(points).subspan(first, last + 2 - first), reach(lane));
      add_entry(touched[i].first, Entry{id, first, last, box_about(lower, upper)});
      i = end;
    }
  }
  for (std::size_t index = 0; index < network_->junctions.size(); ++index) {
    const Junction& junction = network_->junctions[index];
    if (junction.outline.size() < 3) continue;
    const auto [lower, upper] = bounds(junction.outline, 0.0);
    visit_cells(lower, upper, [&](std::size_t cell) {
      add_junction(cell, JunctionId(static_cast<std::int32_t>(index)));
    });
  }
}

std::size_t LaneLocator::cell_at(const Vec2& point) const {
  const Vec2 offset = (point - origin_) / cell_;
  // comparisons that are false for NaN
  if (!(offset.x() >= 0 && offset.y() >= 0)) return columns_ * lines_;
  if (!(offset.x() < static_cast<double>(columns_) && offset.y() < static_cast<double>(lines_)))
    return columns_ * lines_;
  return static_cast<std::size_t>(offset.y()) * columns_ + static_cast<std::size_t>(offset.x());
}

LaneHit LaneLocator::measure(const Entry& entry, const Vec2& point) const {
  const Lane& lane = network_->lane(entry.lane);
  LaneHit hit;
  hit.lane = entry.lane;
  if (lane.kind == LaneKind::WalkingArea) {
    hit.distance = distance_to_area(lane.outline, point);
    return hit;
  }
  const std::vector<Vec2>& points = lane.centerline.points();
  double nearest = kInfinity;
  for (std::uint32_t i = entry.first; i <= entry.last; ++i) {
    const double from = lane.centerline.along_of_vertex(i),
                 span = lane.centerline.along_of_vertex(i + 1) - from;
    const Vec2 forward = (points[i + 1] - points[i]) / span;
    const Vec2 relative = to_body(point - points[i], forward);
    const double t = std::clamp(relative.x(), 0.0, span);
    const double beyond = relative.x() - t;
    const double distance = std::hypot(beyond, relative.y());
    if (distance >= nearest) continue;
    nearest = distance;
    hit.along = from + t;
    hit.offset = relative.y() >= 0 ? distance : -distance;
    hit.direction = forward;
    // within a bend the wedge between two segments belongs to the lane; beyond its ends nothing
    // does
    const bool first_end = beyond < 0 && i == 0, last_end = beyond > 0 && i + 2 == points.size();
    const double over_end =
        first_end || last_end ? std::max(std::abs(beyond) - kEndTolerance, 0.0) : 0.0;
    const double over_side =
        std::max((over_end > 0 ? std::abs(relative.y()) : distance) - 0.5 * lane.width, 0.0);
    hit.distance = std::hypot(over_end, over_side);
  }
  return hit;
}

bool LaneLocator::on_junction(const Vec2& point) const {
  const std::size_t cell = cell_at(point);
  if (cell >= columns_ * lines_) return false;
  for (std::uint32_t k = junction_begin_[cell]; k < junction_begin_[cell + 1]; ++k)
    if (ring_contains(network_->junction(junctions_[k]).outline, point)) return true;
  return false;
}

LaneHit LaneLocator::find_nearest(const Vec2& point, VehicleClassMask classes, double heading,
                                  double reach) const {
  LaneHit best;
  best.distance = kInfinity;
  if (columns_ == 0 || !point.allFinite()) return best;
  const Vec2 forward = direction_of(heading);
  double best_agreement = -2.0;
  const Vec2 place = point - origin_;
  auto consider = [&](std::size_t cell) {
    for (std::uint32_t k = entry_begin_[cell]; k < entry_begin_[cell + 1]; ++k) {
      if (!entries_[k].box.is_within(place, std::min(reach, best.distance))) continue;
      const Lane& lane = network_->lane(entries_[k].lane);
      if (!(lane.allowed & classes)) continue;
      const LaneHit hit = measure(entries_[k], point);
      if (hit.distance > reach || hit.distance > best.distance) continue;
      const bool any_direction =
          !(lane.allowed & ~vehicle_class::kPedestrian) || lane.kind == LaneKind::WalkingArea;
      const double agreement = any_direction ? 1.0 : hit.direction.dot(forward);
      const bool better = hit.distance < best.distance || agreement > best_agreement ||
                          (agreement == best_agreement && hit.lane < best.lane);
      if (!better) continue;
      best = hit;
      best_agreement = agreement;
    }
  };
  // growing squares: a lane found within a square's inner radius can't be beaten from outside it
  for (double radius = 0.0;; radius = std::max(2.0 * radius, cell_)) {
    const double half = std::min(radius, reach);
    best = LaneHit{};
    best.distance = kInfinity;
    best_agreement = -2.0;
    visit_cells(point - Vec2(half, half), point + Vec2(half, half), consider);
    if (best.distance <= half || half >= reach) return best;
  }
}

}  // namespace sumogamma
