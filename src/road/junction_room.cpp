#include "road/junction_room.h"

#include <algorithm>

#include "road/lane_locator.h"

namespace sumogamma {

namespace {

constexpr double kMost = 1.5;    ///< beside a lane [m]
constexpr double kAside = 0.25;  ///< looked at in these steps [m]
constexpr double kAlong = 2.0;   ///< likewise along the lane [m]
constexpr VehicleClassMask kMotor =
    vehicle_class::kPassenger | vehicle_class::kBus | vehicle_class::kTruck;

bool is_driven(const Lane& lane) {
  return lane.kind != LaneKind::WalkingArea && lane.kind != LaneKind::Crossing &&
         (lane.allowed & kMotor) != 0;
}

bool is_walkway(const RoadNetwork& network, const LaneLocator& locator, const Vec2& place,
                std::vector<LaneHit>& hits) {
  locator.find_containing(place, hits);
  const auto driven = [&](const LaneHit& hit) { return is_driven(network.lane(hit.lane)); };
  const auto walked = [&](const LaneHit& hit) {
    const Lane& lane = network.lane(hit.lane);
    return lane.kind == LaneKind::WalkingArea ||
           (lane.kind == LaneKind::Normal && lane.allowed == vehicle_class::kPedestrian);
  };
  return std::none_of(hits.begin(), hits.end(), driven) &&
         std::any_of(hits.begin(), hits.end(), walked);
}

/// Room beside a lane on a junction, to its left (side 1) or right (-1) [m].
double room_beside(const RoadNetwork& network, const LaneLocator& locator, const Lane& lane,
                   double side, std::vector<LaneHit>& hits) {
  const Polyline& line = lane.centerline;
  double most = is_without_motors(lane) ? 0.0 : kMost;
  for (double along = 0.0; along <= line.length(); along += kAlong) {
    const Vec2 kerb = line.point_at(along);
    const Vec2 outwards = side * left_of(line.direction_at(along));
    for (double aside = kAside; aside <= most; aside += kAside)
      if (is_walkway(network, locator, kerb + (0.5 * lane.width + aside) * outwards, hits))
        most = aside - kAside;
  }
  return most;
}

}  // namespace

void set_junction_rooms(RoadNetwork& network, Workers& workers) {
  const LaneLocator locator(network);
  workers.for_each_range(network.lanes.size(),
                         [&](std::size_t, std::size_t begin, std::size_t end) {
                           std::vector<LaneHit> hits;
                           for (std::size_t i = begin; i < end; ++i) {
                             Lane& lane = network.lanes[i];
                             if (lane.kind != LaneKind::Internal) continue;
                             lane.beside_left = room_beside(network, locator, lane, 1.0, hits);
                             lane.beside_right = room_beside(network, locator, lane, -1.0, hits);
                           }
                         });
}

}  // namespace sumogamma
