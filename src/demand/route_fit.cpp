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
bool turns_suit(const RoadNetwork& road, std::span<const std::string> edges, double length) {
  constexpr double kReach = 6.0;  // directions are taken this far from the junction [m]
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const Polyline& in =
        road.lane(road.edge(road.edge_by_name.at(edges[i])).lanes.back()).centerline;
    const Polyline& out =
        road.lane(road.edge(road.edge_by_name.at(edges[i + 1])).lanes.back()).centerline;
    const Vec2 before = in.point_at(in.length()) - in.point_at(in.length() - kReach);
    const Vec2 after = out.point_at(kReach) - out.point_at(0);
    if (std::abs(std::atan2(cross(before, after), before.dot(after))) > sharpest_turn(length))
      return false;
  }
  return true;
}

/// Least lane changes that a class has to make on the middle one of three edges.
int lane_changes_on(const RoadNetwork& road, std::span<const std::string> edges,
                    VehicleClassMask mask) {
  const auto edge_at = [&](std::size_t k) { return road.edge_by_name.at(edges[k]); };
  const auto each_way = [&](std::size_t k, auto&& visit) {
    for (const LaneId from : road.edge(edge_at(k)).lanes)
      for (const ConnectionId id : road.lane(from).outgoing) {
        const Lane& to = road.lane(road.connection(id).to);
        if (to.edge == edge_at(k + 1) && (to.allowed & road.lane(from).allowed & mask) != 0)
          visit(road.lane(from).index, to.index);
      }
  };
  int least = std::numeric_limits<int>::max();
  each_way(0, [&](int, int entered) {
    each_way(1, [&](int left, int) { least = std::min(least, std::abs(left - entered)); });
  });
  return least == std::numeric_limits<int>::max() ? 0 : least;
}

/// True where the route leaves room for the lane changes that it needs: nobody who knows the place
/// turns into a road to cross two of its lanes just before the next junction. Over the few metres
/// between the arms of a split junction one drives as over a junction.
bool lane_changes_suit(const RoadNetwork& road, std::span<const std::string> edges,
                       VehicleClassMask mask) {
  constexpr double kEach = 50.0, kRoad = 10.0;  // [m]
  for (std::size_t i = 0; i + 2 < edges.size(); ++i) {
    const int changes = lane_changes_on(road, edges.subspan(i, 3), mask);
    const Edge& edge = road.edge(road.edge_by_name.at(edges[i + 1]));
    const double length = road.lane(edge.lanes.front()).length;
    if (changes > 1 && length > kRoad && length < kEach * changes) return false;
  }
  return true;
}

}  // namespace

bool turns_back(const RoadNetwork& road, std::span<const std::string> edges) {
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    if (are_opposite(road.edge(road.edge_by_name.at(edges[i])),
                     road.edge(road.edge_by_name.at(edges[i + 1]))))
      return true;
  }
  return false;
}

bool suits(const RoadNetwork& road, const AgentType& type, std::span<const std::string> edges) {
  return turns_suit(road, edges, type.length) &&
         lane_changes_suit(road, edges, vehicle_class_from_name(type.sumo_class));
}

}  // namespace sumogamma
