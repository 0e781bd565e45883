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

}  // namespace

void bound_walking_areas(const RoadNetwork& network, double least, Path& path) {
  constexpr double kPiece = 1.0;  // [m]
  std::vector<PathStretch> pieces;
  for (const PathStretch& stretch : path.stretches) {
    const Lane& area = network.lane(stretch.lane);
    const double length = stretch.to - stretch.from;
    if (area.kind != LaneKind::WalkingArea || area.outline.size() < 3 || length <= 0.0) {
      pieces.push_back(stretch);
      continue;
    }
    const int count = static_cast<int>(std::ceil(length / kPiece));
    for (int i = 0; i < count; ++i) {
      PathStretch piece = stretch;
      piece.from = stretch.from + length * i / count;
      piece.to = stretch.from + length * (i + 1) / count;
      piece.lane_from = stretch.lane_from + piece.from - stretch.from;
      const double middle = 0.5 * (piece.from + piece.to);
      const Vec2 point = path.line.point_at(middle), left = left_of(path.line.direction_at(middle));
      if (ring_contains(area.outline, point)) {
        piece.room_left = std::max(room_within(area.outline, point, left), least);
        piece.room_right = std::max(room_within(area.outline, point, -left), least);
      }
      pieces.push_back(piece);
    }
  }
  path.stretches = std::move(pieces);
}

}  // namespace sumogamma
