#include "osm/lane_clearing.h"

#include <algorithm>
#include <cmath>

#include "road/lane_locator.h"

namespace sumogamma::osm {
namespace {

constexpr double kCell = 10.0;          // [m]
constexpr double kFootClearance = 0.8;  // [m] to either side of a sidewalk's middle
constexpr double kOffGround = 2.5;      // [m] over or under the street
constexpr double kBesideTunnel = 1.5;   // [m] beyond a lane up there or down there
constexpr double kJoint = 0.3;          // [m] by which pieces overlap, so that bends leave no gap

std::uint64_t cell_key(std::int64_t column, std::int64_t row) {
  return (static_cast<std::uint64_t>(column + (1 << 30)) << 32) |
         static_cast<std::uint64_t>(row + (1 << 30));
}

/// Is a segment of the lane well over or under the street?
bool is_off_the_ground(const Lane& lane, std::size_t segment) {
  return !lane.elevation.empty() && std::min(std::abs(lane.elevation[segment]),
                                             std::abs(lane.elevation[segment + 1])) > kOffGround;
}

double half_width_of(const Lane& lane, std::size_t segment) {
  if (is_off_the_ground(lane, segment)) return lane.width / 2 + kBesideTunnel;
  const bool feet = lane.kind == LaneKind::Normal && is_without_motors(lane);
  return feet ? std::min(lane.width / 2, kFootClearance) : lane.width / 2;
}

void merge(std::vector<Stretch>& stretches) {
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  std::vector<Stretch> merged;
  for (const Stretch& stretch : stretches) {
    if (!merged.empty() && stretch.from <= merged.back().to)
      merged.back().to = std::max(merged.back().to, stretch.to);
    else
      merged.push_back(stretch);
  }
  stretches = std::move(merged);
}

bool boxes_meet(const std::vector<Vec2>& ring, const Vec2& low, const Vec2& high) {
  Vec2 ring_low = ring[0], ring_high = ring[0];
  for (const Vec2& p : ring) {
    ring_low = ring_low.cwiseMin(p);
    ring_high = ring_high.cwiseMax(p);
  }
  return (ring_low.array() <= high.array()).all() && (low.array() <= ring_high.array()).all();
}

/// Stretches of a-b within a ring: cut at each crossing, then each part asked by its middle.
void append_within_ring(const std::vector<Vec2>& ring, const Vec2& a, const Vec2& b,
                        std::vector<Stretch>& stretches) {
  std::vector<double> cuts = {0.0, 1.0};
  const Vec2 d = b - a;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vec2 e = ring[i] - ring[j], w = ring[j] - a;
    const double cross = d.x() * e.y() - d.y() * e.x();
    if (cross == 0) continue;
    const double t = (w.x() * e.y() - w.y() * e.x()) / cross,
                 u = (w.x() * d.y() - w.y() * d.x()) / cross;
    if (t > 0 && t < 1 && u >= 0 && u <= 1) cuts.push_back(t);
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    if (cuts[i] < cuts[i + 1] && ring_contains(ring, a + (cuts[i] + cuts[i + 1]) / 2 * d))
      stretches.push_back({cuts[i], cuts[i + 1]});
}

}  // namespace

std::vector<WalkingEnd> walking_ends(const RoadNetwork& road, const Lane& area) {
  const std::vector<Vec2>& outline = area.centerline.points();
  std::vector<LaneId> lanes;
  for (const ConnectionId id : area.incoming) lanes.push_back(road.connection(id).from);
  for (const ConnectionId id : area.outgoing) lanes.push_back(road.connection(id).to);
  std::sort(lanes.begin(), lanes.end());
  lanes.erase(std::unique(lanes.begin(), lanes.end()), lanes.end());
  std::vector<WalkingEnd> ends;
  for (const LaneId id : lanes) {
    const std::vector<Vec2>& points = road.lane(id).centerline.points();
    const bool front =
        distance_to_ring(outline, points.front()) < distance_to_ring(outline, points.back());
    ends.push_back({front ? points.front() : points.back(), road.lane(id).width});
  }
  return ends;
}

template <typename Visit>
void LaneClearing::visit_cells(const Vec2& low, const Vec2& high, Visit visit) const {
  for (auto column = static_cast<std::int64_t>(std::floor(low.x() / kCell));
       column <= static_cast<std::int64_t>(std::floor(high.x() / kCell)); ++column)
    for (auto row = static_cast<std::int64_t>(std::floor(low.y() / kCell));
         row <= static_cast<std::int64_t>(std::floor(high.y() / kCell)); ++row)
      visit(cell_key(column, row));
}

void LaneClearing::add_piece(const Vec2& from, const Vec2& to, double half_width) {
  const double length = (to - from).norm();
  if (length < 1e-6 || half_width <= 0) return;
  const auto index = static_cast<std::uint32_t>(pieces_.size());
  const Vec2 direction = (to - from) / length;
  pieces_.push_back({from - kJoint * direction, direction, length + 2 * kJoint, half_width});
  const Vec2 reach = Vec2::Constant(half_width + kJoint);
  visit_cells(from.cwiseMin(to) - reach, from.cwiseMax(to) + reach,
              [&](std::uint64_t cell) { cells_[cell].push_back(index); });
}

LaneClearing::LaneClearing(const RoadNetwork& road) {
  for (const Lane& lane : road.lanes) {
    if (lane.kind == LaneKind::WalkingArea) {
      const std::vector<Vec2>& outline =
          lane.outline.empty() ? lane.centerline.points() : lane.outline;
      if (outline.size() < 3) continue;
      walking_areas_.push_back(outline);
      const std::vector<WalkingEnd> ends = walking_ends(road, lane);
      for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t k = i + 1; k < ends.size(); ++k)
          add_piece(ends[i].place, ends[k].place, kFootClearance);
      continue;
    }
    const std::vector<Vec2>& points = lane.centerline.points();
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      add_piece(points[i], points[i + 1], half_width_of(lane, i));
  }
}

std::vector<std::uint32_t> LaneClearing::pieces_near(const Vec2& low, const Vec2& high) const {
  std::vector<std::uint32_t> found;
  visit_cells(low, high, [&](std::uint64_t cell) {
    if (const auto entry = cells_.find(cell); entry != cells_.end())
      found.insert(found.end(), entry->second.begin(), entry->second.end());
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<Stretch> LaneClearing::stretches_on_lanes(const Vec2& from, const Vec2& to) const {
  std::vector<Stretch> stretches;
  for (const std::uint32_t index : pieces_near(from.cwiseMin(to), from.cwiseMax(to))) {
    const Piece& piece = pieces_[index];
    const Vec2 normal(-piece.direction.y(), piece.direction.x());
    // in the piece's own frame the rectangle is a box: Liang and Barsky again
    const Vec2 a(piece.direction.dot(from - piece.from), normal.dot(from - piece.from));
    const Vec2 b(piece.direction.dot(to - piece.from), normal.dot(to - piece.from));
    const Vec2 low(0, -piece.half_width), high(piece.length, piece.half_width);
    Stretch stretch{0, 1};
    bool meets = true;
    for (int axis = 0; axis < 2 && meets; ++axis) {
      const double d = b[axis] - a[axis];
      if (std::abs(d) < 1e-12) {
        meets = a[axis] >= low[axis] && a[axis] <= high[axis];
        continue;
      }
      const double s = (low[axis] - a[axis]) / d, t = (high[axis] - a[axis]) / d;
      stretch.from = std::max(stretch.from, std::min(s, t));
      stretch.to = std::min(stretch.to, std::max(s, t));
    }
    if (meets && stretch.from < stretch.to) stretches.push_back(stretch);
  }
  const Vec2 low = from.cwiseMin(to), high = from.cwiseMax(to);
  for (const std::vector<Vec2>& ring : walking_areas_) {
    if (boxes_meet(ring, low, high)) append_within_ring(ring, from, to, stretches);
  }
  merge(stretches);
  return stretches;
}

std::vector<std::vector<Vec2>> LaneClearing::polygons_near(const Vec2& low,
                                                           const Vec2& high) const {
  std::vector<std::vector<Vec2>> polygons;
  for (const std::uint32_t index : pieces_near(low, high)) {
    const Piece& piece = pieces_[index];
    const Vec2 side = piece.half_width * Vec2(-piece.direction.y(), piece.direction.x());
    const Vec2 end = piece.from + piece.length * piece.direction;
    polygons.push_back({piece.from - side, end - side, end + side, piece.from + side});
  }
  for (const std::vector<Vec2>& ring : walking_areas_)
    if (boxes_meet(ring, low, high)) polygons.push_back(ring);
  return polygons;
}

bool LaneClearing::touches_lane(const Vec2& center, double radius) const {
  const Vec2 reach = Vec2::Constant(radius);
  for (const std::uint32_t index : pieces_near(center - reach, center + reach)) {
    const Piece& piece = pieces_[index];
    const Vec2 at = center - piece.from;
    const double along = piece.direction.dot(at),
                 across = piece.direction.x() * at.y() - piece.direction.y() * at.x();
    if (along > -radius && along < piece.length + radius &&
        std::abs(across) < piece.half_width + radius)
      return true;
  }
  return false;
}

}  // namespace sumogamma::osm
