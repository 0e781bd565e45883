#include "demand/riders.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "demand/draws.h"
#include "demand/trip_routing.h"

namespace sumogamma {
namespace {

constexpr double kCatchment = 400.0;  // that people walk to a bus: a quarter of a mile [m]
constexpr double kDetour = 1.5;       // of the way on foot over what the graph tells
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
    if (trip.length > kDetour * kCatchment) continue;
    walks.to[trip.edges.back()].push_back(trip.edges);
    walks.from[trip.edges.front()].push_back(trip.edges);
  }
  return true;
}

using WalksByEdge = std::map<std::string, std::vector<std::vector<std::string>>>;

const std::vector<std::vector<std::string>>* walks_at(const RoadNetwork& road, const BusStop& stop,
                                                      const WalksByEdge& walks) {
  const EdgeId edge = walked_edge(road, stop);
  if (edge == kNoEdge) return nullptr;
  const auto found = walks.find(road.edge(edge).name);
  return found == walks.end() ? nullptr : &found->second;
}

/// Where one can get on and off each part: rows of its stops that people can walk to, or from.
struct Boarding {
  std::vector<std::size_t> on, off;
  bool any() const { return !on.empty() && !off.empty() && on.front() < off.back(); }
};

Boarding boarding_of(const RoadNetwork& road, const PublicTransport& transport,
                     const LinePart& part, const Walks& walks) {
  Boarding boarding;
  for (std::size_t i = 0; i < part.stops.size(); ++i) {
    const BusStop& stop = transport.stops[part.stops[i].stop];
    if (walks_at(road, stop, walks.to)) boarding.on.push_back(i);
    if (walks_at(road, stop, walks.from)) boarding.off.push_back(i);
  }
  return boarding;
}

double seconds_on_foot(const RoadNetwork& road, const std::string& edge, double speed) {
  return road.lane(road.edge(road.edge_by_name.at(edge)).lanes.front()).length / speed;
}

/// About how long a walk takes that begins and ends somewhere on its first and last edge [s].
double seconds_of_walk(const RoadNetwork& road, const std::vector<std::string>& edges,
                       double speed) {
  double seconds = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    seconds +=
        (i == 0 || i + 1 == edges.size() ? 0.5 : 1.0) * seconds_on_foot(road, edges[i], speed);
  return edges.size() > 1 ? seconds : kNearStop / speed;
}

/// Puts a rider on the way to a bus that comes at a time: it departs early enough, or, where that
/// is before the begin, further on or near the stop. False where it can't be in time.
bool depart_for(const RoadNetwork& road, double bus_comes, double wait, double speed,
                Rider& rider) {
  while (rider.to.size() > 1 && bus_comes - wait - seconds_of_walk(road, rider.to, speed) < 0)
    rider.to.erase(rider.to.begin());
  const double walk = seconds_of_walk(road, rider.to, speed);
  rider.time = std::max(0.0, bus_comes - wait - walk);
  return rider.time + walk <= bus_comes;
}

/// What riders are drawn by.
struct RiderDraw {
  const RoadNetwork& road;
  const DemandRequest& request;
  const Walks& walks;
  double walking_speed = 0;  ///< [m/s]
};

/// Somebody for one of the buses; nothing where the draw is no ride.
std::optional<Rider> draw_rider(const RiderDraw& draw, const BusRun& run, const Boarding& boarding,
                                DemandDraws& draws) {
  constexpr double kSure = 60.0, kLongest = 600.0;  // before a bus is due [s]
  const auto& [road, request, walks, walking_speed] = draw;
  const PublicTransport& transport = request.transport->transport;
  const LinePart& part = *run.part;
  const double headway = part.headway > 0 ? part.headway : request.transport->headway;
  const std::size_t a = boarding.on[draws.index(boarding.on.size())],
                    b = boarding.off[draws.index(boarding.off.size())];
  const std::size_t boards = part.stops[a].stop, alights = part.stops[b].stop;
  const double share = draws.uniform(), wait_share = draws.uniform();
  if (a >= b || boards == alights) return std::nullopt;
  if (run.first > 0 && part.stops[a].edge <= run.first) return std::nullopt;
  const auto& to = *walks_at(road, transport.stops[boards], walks.to);
  const auto& from = *walks_at(road, transport.stops[alights], walks.from);
  Rider rider{
      0,        to[draws.index(to.size())], from[draws.index(from.size())], share, boards, alights,
      part.line};
  const double comes = run.time + run.arrival[part.stops[a].edge] - run.arrival[run.first];
  // who has to wait long looks into the timetable
  const double wait = kSure + wait_share * (std::clamp(headway, kSure, kLongest) - kSure);
  if (!depart_for(road, comes, wait, walking_speed, rider)) return std::nullopt;
  if (rider.time >= request.duration) return std::nullopt;
  if (!request.profile.empty() && draws.uniform() >= activity_at(request, rider.time))
    return std::nullopt;
  return rider;
}

}  // namespace

std::vector<Rider> draw_riders(const RoadNetwork& road, const AgentTypeTable& types,
                               const DemandRequest& request, std::span<const BusRun> runs,
                               DemandReport& report) {
  std::vector<Rider> riders;
  const auto buses = static_cast<double>(runs.size());
  const double asked = request.transport->riders
                           ? *request.transport->riders * request.duration / 3600.0
                           : kRidersPerBus * buses;
  const auto wanted = static_cast<std::size_t>(std::lround(asked));
  if (runs.empty() || wanted == 0) return riders;
  Walks walks;
  const AgentType& pedestrian = type_of(types, find_agent_type(types, "pedestrian"));
  if (!route_walks(road, pedestrian, request, report, walks)) {
    report.stopped = true;
    return riders;
  }
  std::vector<const BusRun*> usable;
  std::map<const LinePart*, Boarding> boardings;
  for (const BusRun& run : runs) {
    if (!boardings.contains(run.part))
      boardings[run.part] = boarding_of(road, request.transport->transport, *run.part, walks);
    if (boardings[run.part].any()) usable.push_back(&run);
  }
  const RiderDraw draw{road, request, walks, pedestrian.preferred_speed};
  constexpr std::size_t kTries = 30;  // for each that is wanted
  DemandDraws draws(request.seed, 5000000);
  for (std::size_t k = 0; !usable.empty() && k < kTries * wanted && riders.size() < wanted; ++k) {
    const BusRun& run = *usable[draws.index(usable.size())];
    if (auto rider = draw_rider(draw, run, boardings[run.part], draws))
      riders.push_back(std::move(*rider));
  }
  std::stable_sort(riders.begin(), riders.end(),
                   [](const Rider& a, const Rider& b) { return a.time < b.time; });
  if (riders.empty())
    report.transport.problem = "nobody can walk to two stops of a line in time: no riders";
  return riders;
}

}  // namespace sumogamma
