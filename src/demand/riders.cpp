#include "demand/riders.h"

#include <algorithm>
#include <map>
#include <utility>

#include "demand/draws.h"
#include "demand/trip_routing.h"

namespace sumogamma {
namespace {

constexpr double kCatchment = 400.0;  // that people walk to a bus: a quarter of a mile [m]
constexpr double kRidersPerBus = 3.0;
constexpr int kWalks = 6;  // drawn to each stop, and as many from it

/// The edge on which people come to a stop; kNoEdge where nobody can.
EdgeId walked_edge(const RoadNetwork& road, const BusStop& stop) {
  if (stop.access) return road.lane(stop.access->lane).edge;
  const EdgeId own = road.lane(stop.lane).edge;
  return walking_lane(road, own) == kNoLane ? kNoEdge : own;
}

/// Ways on foot, by the edge at which they end or begin.
struct Walks {
  std::map<std::string, std::vector<std::vector<std::string>>> to, from;
};

/// Draws ends of walks about each stop and has them routed; false where it was stopped.
bool route_walks(const RoadNetwork& road, const AgentType& pedestrian, const DemandRequest& request,
                 DemandReport& report, Walks& walks) {
  std::vector<TypeDemand> demands(1);
  TypeDemand& demand = demands[0];
  demand.type = &pedestrian;
  demand.walks = true;
  demand.graph = class_graph(road, vehicle_class::kPedestrian);
  std::vector<EdgeId> ends;
  for (const BusStop& stop : request.transport->transport.stops) {
    const EdgeId edge = walked_edge(road, stop);
    if (edge != kNoEdge && std::find(ends.begin(), ends.end(), edge) == ends.end())
      ends.push_back(edge);
  }
  for (const EdgeId end : ends) {
    const std::vector<double> distance = distances_from(demand.graph, index_of(end));
    std::vector<std::size_t> near;
    std::vector<double> cumulative;
    double total = 0;
    for (const std::size_t edge : demand.graph.edges) {
      if (edge == index_of(end) || !(distance[edge] < kCatchment + demand.graph.length[edge]))
        continue;
      near.push_back(edge);
      cumulative.push_back(total += demand.graph.length[edge]);
    }
    DemandDraws draws(request.seed, 4000000 + index_of(end));
    for (int k = 0; k < kWalks && !near.empty(); ++k) {
      demand.drawn.push_back({near[draws.weighted(cumulative)], index_of(end)});
      demand.drawn.push_back({index_of(end), near[draws.weighted(cumulative)]});
    }
  }
  if (demand.drawn.empty()) return true;
  if (!route_trips(road, request, demands, report)) return false;
  for (RoutedTrip& trip : demand.pool.trips) {
    walks.to[trip.edges.back()].push_back(trip.edges);
    walks.from[trip.edges.front()].push_back(trip.edges);
  }
  return true;
}

/// A ride between two stops of a part.
struct Ride {
  const LinePart* part = nullptr;
  std::size_t boards = 0, alights = 0;  ///< rows of PublicTransport::stops
};

const std::vector<std::vector<std::string>>* walks_at(
    const RoadNetwork& road, const BusStop& stop,
    const std::map<std::string, std::vector<std::vector<std::string>>>& walks) {
  const EdgeId edge = walked_edge(road, stop);
  if (edge == kNoEdge) return nullptr;
  const auto found = walks.find(road.edge(edge).name);
  return found == walks.end() ? nullptr : &found->second;
}

}  // namespace

std::vector<Rider> draw_riders(const RoadNetwork& road, const AgentTypeTable& types,
                               const DemandRequest& request, std::span<const BusRun> runs,
                               DemandReport& report) {
  const PublicTransport& transport = request.transport->transport;
  const auto buses = static_cast<double>(runs.size());
  const double per_hour =
      request.transport->riders.value_or(kRidersPerBus * buses * 3600.0 / request.duration);
  std::vector<Rider> riders;
  if (runs.empty() || per_hour <= 0) return riders;
  Walks walks;
  const AgentType& pedestrian = type_of(types, find_agent_type(types, "pedestrian"));
  if (!route_walks(road, pedestrian, request, report, walks)) {
    report.stopped = true;
    return riders;
  }
  std::map<const LinePart*, double> runs_of;
  for (const BusRun& run : runs) runs_of[run.part] += 1.0;
  std::vector<Ride> rides;
  std::vector<double> cumulative;
  double total = 0;
  for (const LinePart& part : transport.parts) {  // in their order, not that of pointers
    const auto driven = runs_of.find(&part);
    if (driven == runs_of.end()) continue;
    for (std::size_t a = 0; a < part.stops.size(); ++a)
      for (std::size_t b = a + 1; b < part.stops.size(); ++b) {
        const std::size_t boards = part.stops[a].stop, alights = part.stops[b].stop;
        if (boards == alights || !walks_at(road, transport.stops[boards], walks.to) ||
            !walks_at(road, transport.stops[alights], walks.from))
          continue;
        rides.push_back({&part, boards, alights});
        // so that a part's riders are as its buses and stops, not as its pairs of stops
        const auto later = static_cast<double>(part.stops.size() - a - 1);
        cumulative.push_back(total += driven->second / later);
      }
  }
  if (rides.empty()) {
    report.transport.problem = "nobody can walk to two stops of a line: no riders";
    return riders;
  }
  DemandDraws draws(request.seed, 5000000);
  const double interval = 3600.0 / per_hour;
  for (double time = interval * draws.uniform(); time < request.duration;
       time += interval * draws.uniform(0.5, 1.5)) {
    if (!request.profile.empty() && draws.uniform() >= activity_at(request, time)) continue;
    const Ride& ride = rides[draws.weighted(cumulative)];
    const auto& to = *walks_at(road, transport.stops[ride.boards], walks.to);
    const auto& from = *walks_at(road, transport.stops[ride.alights], walks.from);
    riders.push_back({time, to[draws.index(to.size())], from[draws.index(from.size())],
                      draws.uniform(), ride.boards, ride.alights, ride.part->line});
  }
  return riders;
}

}  // namespace sumogamma
