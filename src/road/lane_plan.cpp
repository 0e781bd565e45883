#include "road/lane_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "road/path_pieces.h"

namespace sumogamma {

namespace {

constexpr double kBeyond = 1000.0;  ///< no lane of the last edge has to be left [m]

/// Cost of changing n lanes on an edge: a change needs some 25 m, so short edges cost more.
double change_cost(int changes, double length) {
  if (changes == 0) return 0.0;
  return changes * (1.0 + 50.0 / std::max(length, 5.0));
}

/// Cost of a link that leads aside: where a road widens to more lanes, one of them goes straight
/// on.
double aside_cost(const RoadNetwork& network, const Connection& connection) {
  constexpr double kStraight = 0.7, kRate = 0.1;  // cosine, lane changes a metre
  const Polyline& from = network.lane(connection.from).centerline;
  const Polyline& to = network.lane(connection.to).centerline;
  const Vec2 leaves = from.direction_at(from.length()), enters = to.direction_at(0.0);
  if (leaves.dot(enters) < kStraight) return 0.0;
  // an even bend leads from one end to the other along the mean of their directions
  const Vec2 mean = (leaves + enters).normalized();
  return kRate * std::abs(cross(mean, to.points().front() - from.points().back()));
}

/// The lane changes from lane `entry` of the route's edge `index`, over the lanes of its stops
/// there, to lane `exit`: what they cost. `from`: where they begin [m].
double cost_on_edge(const PathRequest& request, std::size_t index, int entry, int exit, double from,
                    double length) {
  double cost = 0.0;
  for (const RouteStop& stop : request.stops) {
    if (stop.route_index != index || stop.lane_index < 0 || stop.along < from) continue;
    cost += change_cost(std::abs(stop.lane_index - entry), stop.along - from);
    entry = stop.lane_index;
    from = stop.along;
  }
  return cost + change_cost(std::abs(exit - entry), length - from);
}

/// Where a lane of the route's edge can be left for the next edge.
struct Exit {
  double cost = kUnreachable;         ///< from there to the route's end
  ConnectionId link = kNoConnection;  ///< the cheapest
  double onward = 0.0;                ///< drivable on the next edge without another change [m]
};

/// How lane `id` of the route's edge `index` is left; `next` are the options of the edge behind it.
Exit exit_of(const RoadNetwork& network, const PathRequest& request, std::size_t index, LaneId id,
             const std::vector<LaneOption>* next) {
  const Lane& lane = network.lane(id);
  Exit exit;
  if (next == nullptr) exit.onward = kBeyond;
  if (!allows(lane, request.vehicle_class)) return exit;
  if (next == nullptr) {
    exit.cost = 0.0;
    return exit;
  }
  for (const ConnectionId link : lane.outgoing) {
    const Lane& target = network.lane(network.connection(link).to);
    if (target.edge != request.route[index + 1] || !allows(target, request.vehicle_class)) continue;
    const LaneOption& option = (*next)[static_cast<std::size_t>(target.index)];
    exit.onward = std::max(exit.onward, option.drivable);
    const double cost = option.cost + aside_cost(network, network.connection(link));
    if (cost < exit.cost) {
      exit.cost = cost;
      exit.link = link;
    }
  }
  return exit;
}

/// The cheapest way on from lane `entry` of the route's edge `index`, `length` [m] long.
LaneOption cheapest_from(const PathRequest& request, std::size_t index, std::size_t entry,
                         double length, const std::vector<Exit>& exits) {
  LaneOption choice;
  // who starts at the end of an edge has little room to change on it
  const double begin = index == 0 ? request.start_along : 0.0;
  for (std::size_t exit = 0; exit < exits.size(); ++exit) {
    const double cost = exits[exit].cost + cost_on_edge(request, index, static_cast<int>(entry),
                                                        static_cast<int>(exit), begin, length);
    if (cost < choice.cost)
      choice = {.cost = cost, .exit_index = static_cast<int>(exit), .next = exits[exit].link};
  }
  choice.leave_cost = exits[entry].cost;
  choice.leave = exits[entry].link;
  choice.drivable = length + exits[entry].onward;
  return choice;
}

}  // namespace

std::vector<std::vector<LaneOption>> plan_lanes(const RoadNetwork& network,
                                                const PathRequest& request) {
  const std::size_t edges = request.route.size();
  std::vector<std::vector<LaneOption>> plan(edges);
  std::vector<Exit> exits;
  for (std::size_t i = edges; i-- > 0;) {
    const Edge& edge = network.edge(request.route[i]);
    exits.clear();
    for (const LaneId id : edge.lanes)
      exits.push_back(exit_of(network, request, i, id, i + 1 < edges ? &plan[i + 1] : nullptr));
    plan[i].resize(edge.lanes.size());
    for (std::size_t entry = 0; entry < edge.lanes.size(); ++entry) {
      const Lane& lane = network.lane(edge.lanes[entry]);
      if (allows(lane, request.vehicle_class))
        plan[i][entry] = cheapest_from(request, i, entry, lane.centerline.length(), exits);
    }
  }
  return plan;
}

}  // namespace sumogamma
