#include "outputs/front_place.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

constexpr VehicleClassMask kOnWheels = vehicle_class::kMotor | vehicle_class::kBicycle;

double offset_from(const Lane& lane, const Vec2& point) {
  return std::abs(lane.centerline.project(point).offset);
}

/// The lane of an edge that a point is on, or nearest to.
LaneId lane_at(const RoadNetwork& network, LaneId expected, const Vec2& point, LaneId last) {
  constexpr double kOver = 0.3;  // [m]
  const Lane& lane = network.lane(expected);
  if (lane.kind != LaneKind::Normal) return expected;
  if (last != kNoLane && network.lane(last).edge == lane.edge) {
    if (offset_from(network.lane(last), point) <= 0.5 * network.lane(last).width + kOver)
      return last;
  } else if (offset_from(lane, point) <= 0.5 * lane.width) {
    return expected;
  }
  LaneId best = expected;
  double least = offset_from(lane, point);
  for (const LaneId beside : network.edge(lane.edge).lanes) {
    const Lane& other = network.lane(beside);
    if ((other.allowed & kOnWheels) == 0) continue;
    const double offset = offset_from(other, point);
    if (offset >= least) continue;
    best = beside;
    least = offset;
  }
  return best;
}

}  // namespace

std::optional<FrontPlace> front_place(const RoadNetwork& network, const RoadState& road,
                                      const Scene& scene, std::size_t row, double length,
                                      LaneId last) {
  const Path* path = road.path(scene.path[row]);
  if (path == nullptr || path->stretches.empty()) return std::nullopt;
  const Vec2 front = scene.position[row] + 0.5 * length * direction_of(scene.heading[row]);
  // the place on the path is that of a tick ago
  constexpr double kBack = 4.0, kAhead = 8.0;
  const double about = scene.path_along[row] + 0.5 * length;
  const double along =
      path->line.project(front, about - kBack, about + kAhead + scene.speed[row]).along;
  const PathStretch& stretch = path->stretch_at(along);
  FrontPlace place;
  place.lane = lane_at(network, stretch.lane, front, last);
  const Lane& lane = network.lane(place.lane);
  const double whole = lane.centerline.length();
  const double scale = whole > 0.0 ? lane.length / whole : 1.0;
  place.along = std::clamp(lane.centerline.project(front).along * scale, 0.0, lane.length);
  return place;
}

}  // namespace sumogamma
