#include "demand/route_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace sumogamma {
namespace {

/// Sharpest turn that a body of this length gets round from lane to lane without swinging out over
/// others [rad].
double sharpest_turn(double length) {
  if (length < 3.0) return kPi;
  return length < 5.5 ? radians(130.0) : length < 6.5 ? radians(115.0) : radians(100.0);
}

/// True where every turn of the route suits the type's length.
bool turns_suit(const RoadNetwork& road, std::span<const EdgeId> route, double length) {
  constexpr double kReach = 6.0;  // directions are taken this far from the junction [m]
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Polyline& in = road.lane(road.edge(route[i]).lanes.back()).centerline;
    const Polyline& out = road.lane(road.edge(route[i + 1]).lanes.back()).centerline;
    const Vec2 before = in.point_at(in.length()) - in.point_at(in.length() - kReach);
    const Vec2 after = out.point_at(kReach) - out.point_at(0);
    if (std::abs(std::atan2(cross(before, after), before.dot(after))) > sharpest_turn(length))
      return false;
  }
  return true;
}

/// Least lane changes that a class has to make on the middle one of three edges.
int lane_changes_on(const RoadNetwork& road, std::span<const EdgeId, 3> edges,
                    VehicleClassMask mask) {
  constexpr int kNone = std::numeric_limits<int>::max();
  int least = kNone;
  const Edge& middle = road.edge(edges[1]);
  for (const LaneId before : road.edge(edges[0]).lanes)
    for (const ConnectionId in : road.lane(before).outgoing) {
      if (!leads_onto(road, in, edges[1], mask)) continue;
      const int entered = road.lane(road.connection(in).to).index;
      for (const LaneId left : middle.lanes) {
        const auto& ways = road.lane(left).outgoing;
        if (std::any_of(ways.begin(), ways.end(),
                        [&](ConnectionId out) { return leads_onto(road, out, edges[2], mask); }))
          least = std::min(least, std::abs(road.lane(left).index - entered));
      }
    }
  return least == kNone ? 0 : least;
}

/// True where the route leaves room for the lane changes that it needs: nobody who knows the place
/// turns into a road to cross two of its lanes just before the next junction. Over the few metres
/// between the arms of a split junction one drives as over a junction.
bool lane_changes_suit(const RoadNetwork& road, std::span<const EdgeId> route,
                       VehicleClassMask mask) {
  constexpr double kEach = 50.0, kRoad = 10.0;  // [m]
  for (std::size_t i = 0; i + 2 < route.size(); ++i) {
    const double length = road.lane(road.edge(route[i + 1]).lanes.front()).length;
    if (length <= kRoad) continue;
    const int changes = lane_changes_on(road, route.subspan(i).first<3>(), mask);
    if (changes > 1 && length < kEach * changes) return false;
  }
  return true;
}

}  // namespace

bool leads_onto(const RoadNetwork& road, ConnectionId way, EdgeId edge, VehicleClassMask mask) {
  const Connection& connection = road.connection(way);
  const Lane &from = road.lane(connection.from), &to = road.lane(connection.to);
  return to.edge == edge && (to.allowed & from.allowed & mask) != 0;
}

bool turns_back(const RoadNetwork& road, std::span<const EdgeId> route) {
  for (std::size_t i = 0; i + 1 < route.size(); ++i)
    if (are_opposite(road.edge(route[i]), road.edge(route[i + 1]))) return true;
  return false;
}

bool suits(const RoadNetwork& road, const AgentType& type, std::span<const EdgeId> route) {
  return turns_suit(road, route, type.length) &&
         lane_changes_suit(road, route, vehicle_class_from_name(type.sumo_class));
}

}  // namespace sumogamma
