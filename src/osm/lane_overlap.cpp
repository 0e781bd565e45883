#include "osm/lane_overlap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "geometry/box_grid.h"

namespace sumogamma::osm {
namespace {

constexpr double kStep = 2.0;       // [m] between the places looked at
constexpr double kLaneCell = 12.0;  // [m]

constexpr VehicleClassMask kMotors = vehicle_class::kMotorcycle | vehicle_class::kMoped |
                                     vehicle_class::kPassenger | vehicle_class::kDelivery |
                                     vehicle_class::kTruck | vehicle_class::kTrailer |
                                     vehicle_class::kBus | vehicle_class::kTaxi;

/// A segment of a lane's middle line.
struct Piece {
  LaneId lane = kNoLane;
  std::size_t segment = 0;
};

/// Pieces of all lanes, by the cells that a strip of their width touches.
struct PieceGrid {
  std::vector<Piece> pieces;
  BoxGrid grid{kLaneCell};

  PieceGrid(const RoadNetwork& road, double widest) {
    for (std::size_t i = 0; i < road.lanes.size(); ++i) {
      const Lane& lane = road.lanes[i];
      if (lane.kind != LaneKind::Normal) continue;
      const std::vector<Vec2>& points = lane.centerline.points();
      const Vec2 reach = Vec2::Constant((lane.width + widest) / 2);
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        grid.add(static_cast<std::uint32_t>(pieces.size()),
                 points[k].cwiseMin(points[k + 1]) - reach,
                 points[k].cwiseMax(points[k + 1]) + reach);
        pieces.push_back({static_cast<LaneId>(i), k});
      }
    }
  }
};

/// A place on a lane.
struct Place {
  Vec2 point, direction;
  double height = 0, along = 0;
};

/// By how much the strip of `other` covers that of `lane` at the place, where the foot of the
/// perpendicular lies on this piece of it; nothing where it does not or the two do not run along
/// each other.
std::optional<double> overlap_at(const Lane& lane, const Place& place, const Lane& other,
                                 std::size_t segment) {
  const std::vector<Vec2>& points = other.centerline.points();
  const Vec2 along = points[segment + 1] - points[segment];
  const double length = along.norm();
  const Vec2 direction = along / length;
  if (std::abs(direction.dot(place.direction)) < lane_overlap::kAlong) return std::nullopt;
  const double t = direction.dot(place.point - points[segment]);
  // at a bend the feet of two pieces leave a wedge open, but nothing lies beyond a lane's ends
  const bool first = segment == 0, last = segment + 2 == points.size();
  if (t < (first ? 0.0 : -lane.width) || t > length + (last ? 0.0 : lane.width))
    return std::nullopt;
  const double foot = std::clamp(t, 0.0, length);
  const double depth =
      (lane.width + other.width) / 2 - (place.point - points[segment] - foot * direction).norm();
  if (depth <= lane_overlap::kTolerance) return std::nullopt;
  const double height = elevation_at(other, other.centerline.along_of_vertex(segment) + foot);
  if (std::abs(height - place.height) > lane_overlap::kSameHeight) return std::nullopt;
  // two strips never share more than the narrower one's width
  return std::min({depth, lane.width, other.width});
}

struct Hit {
  std::size_t step = 0;
  double depth = 0;
};

/// Puts steps that follow one another together, and keeps what is long enough.
void append_stretches(LaneId lane, LaneId other, const std::vector<Hit>& hits, double step,
                      std::vector<LaneOverlap>& overlaps) {
  for (std::size_t i = 0; i < hits.size();) {
    std::size_t end = i + 1;
    double depth = hits[i].depth;
    for (; end < hits.size() && hits[end].step == hits[end - 1].step + 1; ++end)
      depth = std::max(depth, hits[end].depth);
    const double from = static_cast<double>(hits[i].step) * step,
                 to = static_cast<double>(hits[end - 1].step + 1) * step;
    if (to - from > lane_overlap::kShortest) overlaps.push_back({lane, other, from, to, depth});
    i = end;
  }
}

void append_overlaps_of(const RoadNetwork& road, const PieceGrid& grid, LaneId id,
                        std::vector<LaneOverlap>& overlaps) {
  const Lane& lane = road.lane(id);
  const Edge& edge = road.edge(lane.edge);
  const double length = lane.centerline.length();
  const auto steps = static_cast<std::size_t>(std::ceil(length / kStep));
  const double step = length / static_cast<double>(std::max<std::size_t>(steps, 1));
  std::map<LaneId, std::vector<Hit>> hits;
  for (std::size_t i = 0; i < steps; ++i) {
    const double along = (static_cast<double>(i) + 0.5) * step;
    const Place place{lane.centerline.point_at(along), lane.centerline.direction_at(along),
                      elevation_at(lane, along), along};
    for (const std::uint32_t index : grid.grid.at(place.point)) {
      const Piece& piece = grid.pieces[index];
      const Lane& other = road.lane(piece.lane);
      if (other.edge == lane.edge || !must_be_apart(lane_use(lane), lane_use(other))) continue;
      if (at_shared_junction(edge, road.edge(other.edge), along, length - along)) continue;
      const std::optional<double> depth = overlap_at(lane, place, other, piece.segment);
      if (!depth) continue;
      std::vector<Hit>& of_other = hits[piece.lane];
      if (of_other.empty() || of_other.back().step != i) of_other.push_back({i, 0.0});
      of_other.back().depth = std::max(of_other.back().depth, *depth);
    }
  }
  for (const auto& [other, of_other] : hits) append_stretches(id, other, of_other, step, overlaps);
}

}  // namespace

LaneUse lane_use(const Lane& lane) {
  if ((lane.allowed & kMotors) != 0) return LaneUse::Driving;
  return (lane.allowed & vehicle_class::kBicycle) != 0 ? LaneUse::Cycling : LaneUse::Walking;
}

bool at_shared_junction(const Edge& edge, const Edge& other, double from_begin, double to_end) {
  constexpr double kReach = 3.0;  // [m]
  const auto touches = [&](JunctionId junction) {
    return junction != kNoJunction && (other.from == junction || other.to == junction);
  };
  return (from_begin < kReach && touches(edge.from)) || (to_end < kReach && touches(edge.to));
}

std::vector<LaneOverlap> find_lane_overlaps(const RoadNetwork& road) {
  double widest = 0;
  for (const Lane& lane : road.lanes)
    if (lane.kind == LaneKind::Normal) widest = std::max(widest, lane.width);
  const PieceGrid grid(road, widest);
  std::vector<LaneOverlap> overlaps;
  for (std::size_t i = 0; i < road.lanes.size(); ++i)
    if (road.lanes[i].kind == LaneKind::Normal)
      append_overlaps_of(road, grid, static_cast<LaneId>(i), overlaps);
  return overlaps;
}

OverlapLength overlap_length(const RoadNetwork& road, const std::vector<LaneOverlap>& overlaps) {
  OverlapLength length;
  for (const Lane& lane : road.lanes)
    if (lane.kind == LaneKind::Normal && lane_use(lane) != LaneUse::Walking)
      length.all_wheels += lane.centerline.length();
  LaneId at = kNoLane;
  std::vector<std::pair<double, double>> stretches;
  const auto finish = [&] {
    std::sort(stretches.begin(), stretches.end());
    double reached = 0, sum = 0;
    for (const auto& [from, to] : stretches) {
      sum += std::max(0.0, to - std::max(from, reached));
      reached = std::max(reached, to);
    }
    if (at != kNoLane)
      (lane_use(road.lane(at)) == LaneUse::Walking ? length.walking : length.wheels) += sum;
    stretches.clear();
  };
  for (const LaneOverlap& overlap : overlaps) {
    if (lane_use(road.lane(overlap.lane)) != LaneUse::Walking &&
        lane_use(road.lane(overlap.other)) == LaneUse::Walking)
      continue;  // counted from the walking side
    if (overlap.lane != at) finish();
    at = overlap.lane;
    stretches.emplace_back(overlap.from, overlap.to);
  }
  finish();
  return length;
}

}  // namespace sumogamma::osm
