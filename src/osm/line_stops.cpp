#include "osm/line_stops.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace sumogamma::osm {

namespace {

constexpr double kLength = 15.0;  // a bus of 12 m, and room to halt in [m]
constexpr double kEnds = 1.0;     // kept free at either end of a lane [m]

/// The lane next to the kerb that a bus may use.
LaneId kerb_lane(const RoadNetwork& road, EdgeId edge) {
  for (const LaneId id : road.edge(edge).lanes)
    if ((road.lane(id).allowed & vehicle_class::kBus) != 0) return id;
  return kNoLane;
}

/// Where people reach a stop from whose own edge nobody walks along: the nearest lane for walking.
std::optional<StopAccess> access_to(const RoadNetwork& road, const BusStop& stop) {
  constexpr double kReach = 30.0;  // [m]
  const Lane& own = road.lane(stop.lane);
  if (walking_lane(road, own.edge) != kNoLane) return std::nullopt;
  const double scale = own.length > 0 ? own.centerline.length() / own.length : 1.0;
  const Vec2 middle = own.centerline.point_at(scale * 0.5 * (stop.begin + stop.end));
  std::optional<StopAccess> access;
  double nearest = kReach;
  for (std::size_t i = 0; i < road.edges.size(); ++i) {
    if (road.edges[i].kind != LaneKind::Normal) continue;
    const LaneId id = walking_lane(road, static_cast<EdgeId>(i));
    if (id == kNoLane || road.lane(id).layer != own.layer) continue;
    const Lane& lane = road.lane(id);
    const PolylinePosition place =
        lane.centerline.project_near(middle, 0, lane.centerline.length(), nearest);
    if (!(place.distance < nearest)) continue;
    nearest = place.distance;
    const double share = lane.centerline.length() > 0 ? place.along / lane.centerline.length() : 0;
    access = StopAccess{id, share * lane.length};
  }
  return access;
}

}  // namespace

/// Where a stop may lie along a route.
struct StopPlacer::Spot {
  std::size_t edge = 0;  ///< row of the route
  LaneId lane = kNoLane;
  double begin = 0;     ///< of the stop on the lane [m]
  double along = 0;     ///< of its middle on the whole route [m]
  double distance = 0;  ///< of the map's stop from the lane [m]
};

/// One spot for each time that the route passes the stop.
std::vector<StopPlacer::Spot> StopPlacer::spots_near(std::span<const EdgeId> route,
                                                     const LineStop& stop, bool kerb_only) const {
  constexpr double kReach = 25.0, kOnTheRoad = 2.0, kShift = 40.0;  // [m]
  const Vec2 place = projection_.to_plane(stop.place) + road_.projection_offset;
  std::vector<Spot> spots;
  double before = 0;
  for (std::size_t i = 0; i < route.size(); ++i) {
    const LaneId id = kerb_lane(road_, route[i]);
    const Lane& lane = road_.lane(id);
    const double start = before;
    before += lane.length;
    const PolylinePosition on =
        lane.centerline.project_near(place, 0, lane.centerline.length(), kReach);
    if (!(on.distance < kReach) || lane.length < kLength + 2 * kEnds) continue;
    // the map draws a road as one line: its own stops lie on that, the others' beyond it
    const Lane& inner = road_.lane(road_.edge(route[i]).lanes.back());
    const double side = inner.centerline.project(place).offset * (road_.left_hand ? 1.0 : -1.0);
    if (kerb_only && side < -0.5 * inner.width - kOnTheRoad) continue;
    const double middle = on.along / lane.centerline.length() * lane.length;
    const double begin = std::clamp(middle - 0.5 * kLength, kEnds, lane.length - kLength - kEnds);
    if (std::abs(begin + 0.5 * kLength - middle) > kShift) continue;
    spots.push_back({i, id, begin, start + begin + 0.5 * kLength, on.distance});
  }
  // neighbouring edges are one passing: the nearest of them
  constexpr double kOnePassing = 80.0;  // [m]
  std::vector<Spot> passings;
  for (const Spot& spot : spots) {
    if (passings.empty() || spot.along - passings.back().along > kOnePassing)
      passings.push_back(spot);
    else if (spot.distance < passings.back().distance)
      passings.back() = spot;
  }
  return passings;
}

std::size_t StopPlacer::stop_at(const Spot& spot, const LineStop& stop) {
  constexpr double kSame = 8.0;  // [m]
  std::size_t same_id = 0;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    if (placed_[i].lane == spot.lane && std::abs(placed_[i].begin - spot.begin) < kSame) return i;
    same_id += placed_[i].id == stop.id || placed_[i].id.starts_with(stop.id + "_");
  }
  BusStop placed;
  placed.id = stop.id + (same_id == 0 ? "" : "_" + std::to_string(same_id + 1));
  placed.name = stop.name;
  placed.lane = spot.lane;
  placed.begin = spot.begin;
  placed.end = spot.begin + kLength;
  placed.access = access_to(road_, placed);
  placed_.push_back(std::move(placed));
  return placed_.size() - 1;
}

std::vector<ServedStop> StopPlacer::along(std::span<const EdgeId> route,
                                          const std::vector<LineStop>& stops, bool in_order) {
  constexpr double kApart = 30.0;  // two stops of one line nearer than this are one [m]
  constexpr double kAsNear = 5.0;  // how much nearer a later passing must be to be taken [m]
  struct Found {
    Spot spot;
    const LineStop* stop;
  };
  std::vector<Found> found;
  for (const LineStop& stop : stops) {
    std::vector<Spot> spots = spots_near(route, stop, !in_order);
    if (in_order && !found.empty())
      std::erase_if(
          spots, [&](const Spot& spot) { return spot.along < found.back().spot.along + kApart; });
    if (spots.empty()) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Spot& spot : spots) nearest = std::min(nearest, spot.distance);
    const auto first = std::find_if(spots.begin(), spots.end(), [&](const Spot& spot) {
      return spot.distance <= nearest + kAsNear;
    });
    found.push_back({*first, &stop});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.spot.along < b.spot.along; });
  std::vector<ServedStop> served;
  double last = -kApart;
  for (const Found& one : found) {
    if (one.spot.along < last + kApart) continue;
    last = one.spot.along;
    served.push_back({stop_at(one.spot, *one.stop), one.spot.edge});
  }
  return served;
}

}  // namespace sumogamma::osm
