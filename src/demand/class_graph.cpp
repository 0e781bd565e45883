#include "demand/class_graph.h"

#include <algorithm>
#include <map>
#include <queue>
#include <string>

namespace sumogamma {
namespace {

void link_vehicles(const RoadNetwork& road, VehicleClassMask mask, ClassGraph& graph) {
  for (const std::size_t edge : graph.edges)
    for (const LaneId lane : road.edges[edge].lanes) {
      if ((road.lane(lane).allowed & mask) == 0) continue;
      for (const ConnectionId id : road.lane(lane).outgoing) {
        const Connection& connection = road.connection(id);
        const Lane& target = road.lane(connection.to);
        if ((target.allowed & mask) == 0 || !graph.usable[index_of(target.edge)]) continue;
        graph.next[edge].push_back(index_of(target.edge));
        if (connection.direction != TurnDirection::Turnaround)
          ++graph.entries[index_of(target.edge)];
      }
    }
}

/// People walk both ways and from any sidewalk at a junction to any other, unless the router finds
/// otherwise.
void link_walkers(const RoadNetwork& road, ClassGraph& graph) {
  std::map<JunctionId, std::vector<std::size_t>> at;
  for (const std::size_t edge : graph.edges) {
    at[road.edges[edge].from].push_back(edge);
    at[road.edges[edge].to].push_back(edge);
  }
  for (const std::size_t edge : graph.edges) {
    const JunctionId ends[] = {road.edges[edge].from, road.edges[edge].to};
    bool at_rim = false;
    for (const JunctionId end : ends) {
      std::size_t others = 0;
      for (const std::size_t other : at[end])
        if (other != edge) {
          graph.next[edge].push_back(other);
          // the other direction of the same road is no way on
          others += !are_opposite(road.edges[other], road.edges[edge]);
        }
      at_rim = at_rim || others == 0;
    }
    graph.entries[edge] = at_rim ? 0 : 1;
  }
}

/// Buses and lorries keep to streets that are made for them: two of them can't pass each other in a
/// lane-wide residential street, so that one such meeting would block it for good.
bool wide_enough(const Edge& edge, VehicleClassMask mask) {
  if ((mask & (vehicle_class::kBus | vehicle_class::kTruck)) == 0) return true;
  for (const char* narrow : {"residential", "living_street", "service", "track"})
    if (edge.type.find(narrow) != std::string::npos) return false;
  return (mask & vehicle_class::kBus) == 0 || edge.type.find("unclassified") == std::string::npos;
}

/// `narrow`: with streets that are too narrow for the class, too.
ClassGraph class_graph(const RoadNetwork& road, VehicleClassMask mask, bool narrow) {
  ClassGraph graph;
  graph.usable.resize(road.edges.size());
  graph.next.resize(road.edges.size());
  graph.entries.resize(road.edges.size());
  graph.length.resize(road.edges.size());
  graph.speed.resize(road.edges.size());
  for (std::size_t i = 0; i < road.edges.size(); ++i) {
    const Edge& edge = road.edges[i];
    if (edge.kind != LaneKind::Normal || edge.lanes.empty() || !allows(road, edge, mask)) continue;
    if (!narrow && !wide_enough(edge, mask)) continue;
    graph.usable[i] = true;
    graph.edges.push_back(i);
    graph.length[i] = road.lane(edge.lanes[0]).length;
    for (const LaneId lane : edge.lanes)
      if ((road.lane(lane).allowed & mask) != 0)
        graph.speed[i] = std::max(graph.speed[i], road.lane(lane).speed_limit);
  }
  if (mask == vehicle_class::kPedestrian)
    link_walkers(road, graph);
  else
    link_vehicles(road, mask, graph);
  // a class that has next to no street of its own takes what there is
  constexpr double kLeastNetwork = 600.0;  // [m]
  double length = 0;
  for (const std::size_t edge : graph.edges) length += graph.length[edge];
  if (!narrow && length < kLeastNetwork) return class_graph(road, mask, true);
  for (auto& followers : graph.next) {
    std::sort(followers.begin(), followers.end());
    followers.erase(std::unique(followers.begin(), followers.end()), followers.end());
  }
  return graph;
}

}  // namespace

ClassGraph class_graph(const RoadNetwork& road, VehicleClassMask mask) {
  return class_graph(road, mask, false);
}

std::vector<double> distances_from(const ClassGraph& graph, std::size_t origin) {
  std::vector<double> distance(graph.length.size(), kUnreachable);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[origin] = graph.length[origin];
  open.emplace(distance[origin], origin);
  while (!open.empty()) {
    const auto [so_far, edge] = open.top();
    open.pop();
    if (so_far > distance[edge]) continue;
    for (const std::size_t follower : graph.next[edge]) {
      const double reached = so_far + graph.length[follower];
      if (reached >= distance[follower]) continue;
      distance[follower] = reached;
      open.emplace(reached, follower);
    }
  }
  return distance;
}

}  // namespace sumogamma
