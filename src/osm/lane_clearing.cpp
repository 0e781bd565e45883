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

struct Corners {
  Vec2 low, high;
};

Corners corners_of(const std::vector<Vec2>& ring) {
  Corners corners{ring[0], ring[0]};
  for (const Vec2& p : ring) {
    corners.low = corners.low.cwiseMin(p);
    corners.high = corners.high.cwiseMax(p);
  }
  return corners;
}

bool boxes_meet(const std::vector<Vec2>& ring, const Vec2& low, const Vec2& high) {
  const Corners own = corners_of(ring);
  return (own.low.array() <= high.array()).all() && (low.array() <= own.high.array()).all();
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

void LaneClearing::add_piece(const Vec2& from, const Vec2& to, double half_width) {
  const double length = (to - from).norm();
  if (length < 1e-6 || half_width <= 0) return;
  const auto index = static_cast<std::uint32_t>(pieces_.size());
  const Vec2 direction = (to - from) / length;
  pieces_.push_back({from - kJoint * direction, direction, length + 2 * kJoint, half_width});
  const Vec2 reach = Vec2::Constant(half_width + kJoint);
  piece_grid_.add(index, from.cwiseMin(to) - reach, from.cwiseMax(to) + reach);
}

void LaneClearing::add_walking_area(const RoadNetwork& road, const Lane& area) {
  const std::vector<Vec2>& outline = area.outline.empty() ? area.centerline.points() : area.outline;
  if (outline.size() < 3) return;
  const Corners corners = corners_of(outline);
  area_grid_.add(static_cast<std::uint32_t>(walking_areas_.size()), corners.low, corners.high);
  walking_areas_.push_back(outline);
  const std::vector<WalkingEnd> ends = walking_ends(road, area);
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t k = i + 1; k < ends.size(); ++k)
      add_piece(ends[i].place, ends[k].place, kFootClearance);
}

LaneClearing::LaneClearing(const RoadNetwork& road) : piece_grid_(kCell), area_grid_(kCell) {
  for (const Lane& lane : road.lanes) {
    if (lane.kind == LaneKind::WalkingArea) {
      add_walking_area(road, lane);
      continue;
    }
    const std::vector<Vec2>& points = lane.centerline.points();
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      add_piece(points[i], points[i + 1], half_width_of(lane, i));
  }
}

std::vector<Stretch> LaneClearing::stretches_on_lanes(const Vec2& from, const Vec2& to) const {
  std::vector<Stretch> stretches;
  for (const std::uint32_t index : piece_grid_.near(from.cwiseMin(to), from.cwiseMax(to))) {
    const Piece& piece = pieces_[index];
    const Vec2 normal(-piece.direction.y(), piece.direction.x());
    // in the piece's own frame the rectangle is a box
    const Vec2 a(piece.direction.dot(from - piece.from), normal.dot(from - piece.from));
    const Vec2 b(piece.direction.dot(to - piece.from), normal.dot(to - piece.from));
    if (const auto stretch =
            stretch_in_box(a, b, Vec2(0, -piece.half_width), Vec2(piece.length, piece.half_width)))
      stretches.push_back(*stretch);
  }
  const Vec2 low = from.cwiseMin(to), high = from.cwiseMax(to);
  for (const std::uint32_t index : area_grid_.near(low, high)) {
    const std::vector<Vec2>& ring = walking_areas_[index];
    if (boxes_meet(ring, low, high)) append_within_ring(ring, from, to, stretches);
  }
  merge(stretches);
  return stretches;
}

std::vector<std::vector<Vec2>> LaneClearing::polygons_near(const Vec2& low,
                                                           const Vec2& high) const {
  std::vector<std::vector<Vec2>> polygons;
  for (const std::uint32_t index : piece_grid_.near(low, high)) {
    const Piece& piece = pieces_[index];
    const Vec2 side = piece.half_width * Vec2(-piece.direction.y(), piece.direction.x());
    const Vec2 end = piece.from + piece.length * piece.direction;
    polygons.push_back({piece.from - side, end - side, end + side, piece.from + side});
  }
  for (const std::uint32_t index : area_grid_.near(low, high))
    if (boxes_meet(walking_areas_[index], low, high)) polygons.push_back(walking_areas_[index]);
  return polygons;
}

bool LaneClearing::touches_lane(const Vec2& center, double radius) const {
  const Vec2 reach = Vec2::Constant(radius);
  for (const std::uint32_t index : piece_grid_.near(center - reach, center + reach)) {
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
