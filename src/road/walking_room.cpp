#include "road/walking_room.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "road/lane_locator.h"

namespace sumogamma {

namespace {

/// From a point inside a ring to its boundary in a direction [m].
double room_within(const std::vector<Vec2>& ring, const Vec2& point, const Vec2& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vec2 a = to_body(ring[j] - point, direction), b = to_body(ring[i] - point, direction);
    if ((a.y() > 0.0) == (b.y() > 0.0)) continue;
    const double x = a.x() - a.y() / (b.y() - a.y()) * (b.x() - a.x());
    if (x >= 0.0) nearest = std::min(nearest, x);
  }
  return nearest;
}

double distance_to(const Vec2& a, const Vec2& b, const Vec2& point) {
  const Vec2 along = b - a;
  const double share = (point - a).dot(along) / std::max(along.squaredNorm(), 1e-12);
  return (a + std::clamp(share, 0.0, 1.0) * along - point).norm();
}

using Ring = std::vector<Vec2>;

/// Is a point nearer than `gap` [m] to a ring's boundary?
bool is_beside(const Ring& ring, const Vec2& point, double gap) {
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    if (distance_to(ring[j], ring[i], point) < gap) return true;
  return false;
}

bool is_in_one_of(const std::vector<const Ring*>& areas, const Vec2& point) {
  return std::any_of(areas.begin(), areas.end(),
                     [&](const Ring* area) { return ring_contains(*area, point); });
}

/// From a point to where areas end in a direction [m]: who leaves one of them and is in the next
/// one two steps later doesn't notice.
double room_over(const std::vector<const Ring*>& areas, const Vec2& point, const Vec2& direction) {
  constexpr double kGap = 0.2, kStep = 0.1, kFarthest = 5.0;  // [m]
  double room = 0.0;
  for (const Ring* area : areas)
    if (ring_contains(*area, point)) room = std::max(room, room_within(*area, point, direction));
  if (areas.size() == 1) return room;
  for (double probe = room + kStep; probe < kFarthest; probe += kStep) {
    const Vec2 place = point + probe * direction;
    if (is_in_one_of(areas, place)) {
      room = probe;
    } else if (std::none_of(areas.begin(), areas.end(),
                            [&](const Ring* area) { return is_beside(*area, place, kGap); })) {
      break;
    }
  }
  return room;
}

bool is_area(const Lane& lane) {
  return lane.kind == LaneKind::WalkingArea && lane.outline.size() >= 3;
}

/// Appends a stretch over areas, or over the little road between two, to `pieces`, with the room
/// that they leave beside each piece; where the path lies outside of an area that stays as it is.
void append_bounded(const Path& path, const PathStretch& stretch, bool on_area,
                    const std::vector<const Ring*>& areas, double least,
                    std::vector<PathStretch>& pieces) {
  constexpr double kPiece = 1.0;  // [m]
  const double length = stretch.to - stretch.from;
  const int count = std::max(static_cast<int>(std::ceil(length / kPiece)), 1);
  for (int i = 0; i < count; ++i) {
    PathStretch piece = stretch;
    piece.from = stretch.from + length * i / count;
    piece.to = stretch.from + length * (i + 1) / count;
    piece.lane_from = stretch.lane_from + piece.from - stretch.from;
    const double middle = 0.5 * (piece.from + piece.to);
    const Vec2 point = path.line.point_at(middle), left = left_of(path.line.direction_at(middle));
    if (!on_area || is_in_one_of(areas, point)) {
      piece.room_left = std::max(room_over(areas, point, left), least);
      piece.room_right = std::max(room_over(areas, point, -left), least);
    }
    pieces.push_back(piece);
  }
}

}  // namespace

void bound_walking_areas(const RoadNetwork& network, double least, Path& path) {
  constexpr double kSliver = 1.0;  // [m]
  const std::vector<PathStretch>& stretches = path.stretches;
  const auto is_area_at = [&](std::size_t i) {
    return i < stretches.size() && is_area(network.lane(stretches[i].lane));
  };
  std::vector<PathStretch> pieces;
  for (std::size_t begin = 0; begin < stretches.size();) {
    if (!is_area_at(begin)) {
      pieces.push_back(stretches[begin++]);
      continue;
    }
    // areas with no more than slivers of road between them are one
    std::vector<const Ring*> areas{&network.lane(stretches[begin].lane).outline};
    std::size_t last = begin;
    while (is_area_at(last + 2) && stretches[last + 1].to - stretches[last + 1].from < kSliver) {
      last += 2;
      areas.push_back(&network.lane(stretches[last].lane).outline);
    }
    for (; begin <= last; ++begin)
      append_bounded(path, stretches[begin], is_area_at(begin), areas, least, pieces);
  }
  path.stretches = std::move(pieces);
}

}  // namespace sumogamma
