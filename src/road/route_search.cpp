#include "road/route_search.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace sumogamma {

std::vector<double> free_travel_times(const RoadNetwork& network) {
  std::vector<double> times(network.edges.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (network.edges[i].lanes.empty()) continue;
    const Lane& lane = network.lane(network.edges[i].lanes.back());
    times[i] = lane.centerline.length() / std::max(lane.speed_limit, 1.0);
  }
  return times;
}

std::vector<EdgeId> fastest_route(const RoadNetwork& network, LaneId from, EdgeId destination,
                                  VehicleClassMask vehicle_class,
                                  std::span<const double> travel_time) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  using Reached = std::pair<double, EdgeId>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  std::vector<double> best(network.edges.size(), kNever);
  std::vector<EdgeId> before(network.edges.size(), kNoEdge);
  auto leave = [&](const Lane& lane, double time) {
    for (const ConnectionId id : lane.outgoing) {
      const Connection& link = network.connection(id);
      const Lane& target = network.lane(link.to);
      if ((target.allowed & vehicle_class) == 0 ||
          are_opposite(network.edge(lane.edge), network.edge(target.edge)))
        continue;
      const double then = time + travel_time[index_of(target.edge)];
      if (then >= best[index_of(target.edge)]) continue;
      best[index_of(target.edge)] = then;
      before[index_of(target.edge)] = lane.edge;
      open.emplace(then, target.edge);
    }
  };
  const EdgeId start = network.lane(from).edge;
  leave(network.lane(from), 0.0);
  while (!open.empty()) {
    const auto [time, edge] = open.top();
    open.pop();
    if (time > best[index_of(edge)] || edge == start) continue;
    if (edge == destination) break;
    for (const LaneId lane : network.edge(edge).lanes)
      if ((network.lane(lane).allowed & vehicle_class) != 0) leave(network.lane(lane), time);
  }
  if (best[index_of(destination)] == kNever || destination == start) return {};
  std::vector<EdgeId> route{destination};
  while (route.back() != start) route.push_back(before[index_of(route.back())]);
  std::reverse(route.begin(), route.end());
  return route;
}

}  // namespace sumogamma
