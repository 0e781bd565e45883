#include "demand/demand.h"

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <span>

#include "base/error.h"
#include "demand/draws.h"
#include "demand/riders.h"
#include "demand/transport_xml.h"
#include "demand/trip_draw.h"
#include "demand/trip_routing.h"
#include "demand/trip_weights.h"
#include "demand/trip_window.h"
#include "demand/vehicle_type_xml.h"

namespace sumogamma {
namespace {

bool has_trips(const DemandRequest& request, const std::string& type) {
  return std::any_of(request.trips.begin(), request.trips.end(),
                     [&](const AskedTrips& trips) { return trips.type == type; });
}

/// Those with a share, and those of the table of trips.
std::vector<DemandShare> types_asked_for(const DemandRequest& request) {
  std::vector<DemandShare> all = request.mix;
  for (const AskedTrips& trips : request.trips)
    if (std::none_of(all.begin(), all.end(),
                     [&](const DemandShare& share) { return share.type == trips.type; }))
      all.push_back({trips.type, 0});
  std::erase_if(all, [&](const DemandShare& share) {
    return !(share.share > 0) && !has_trips(request, share.type);
  });
  return all;
}

std::size_t edge_of(const RoadNetwork& road, const std::string& name, const char* what) {
  const auto found = road.edge_by_name.find(name);
  if (found == road.edge_by_name.end())
    throw Error(what, "the network has no edge '" + name.substr(0, 60) + "'");
  return index_of(found->second);
}

/// The trips that are asked for edge by edge: those of a table, and some over each counted edge.
void ask_for_trips(const RoadNetwork& road, const DemandRequest& request,
                   std::vector<TypeDemand>& demands) {
  for (const AskedTrips& trips : request.trips)
    for (TypeDemand& demand : demands) {
      if (demand.type->name != trips.type || trips.per_hour <= 0) continue;
      demand.drawn.push_back({edge_of(road, trips.from, "origin-destination table"),
                              edge_of(road, trips.to, "origin-destination table"),
                              TripEnds::kNowhere, trips.per_hour});
      ++demand.report.trips_drawn;
    }
  for (const EdgeCount& count : request.counts) {
    const std::size_t edge = edge_of(road, count.edge, "counts");
    if (!count.to.empty()) edge_of(road, count.to, "counts");
    for (TypeDemand& demand : demands) draw_trips_over(edge, request.seed, demand);
  }
}

std::vector<TypeDemand> type_demands(const RoadNetwork& road, const AgentTypeTable& types,
                                     const DemandRequest& request, DemandReport& report) {
  std::vector<TypeDemand> demands;
  for (const DemandShare& share : types_asked_for(request)) {
    TypeDemand demand;
    demand.type = &type_of(types, find_agent_type(types, share.type));
    demand.walks = demand.type->sumo_class == "pedestrian";
    demand.report.type = share.type;
    demand.report.share = share.share;
    demand.pool.fixed = has_trips(request, share.type);
    demand.graph = class_graph(road, vehicle_class_from_name(demand.type->sumo_class));
    if (demand.graph.edges.empty()) {
      demand.report.problem = "no edge of the network lets it travel";
      report.types.push_back(demand.report);
      continue;
    }
    demands.push_back(std::move(demand));
  }
  return demands;
}

struct Departure {
  double time = 0;
  std::size_t demand = 0;  ///< row of the type
  std::size_t trip = 0;    ///< row of its routed trip
  std::size_t first = 0;   ///< edge of the route that it starts on
  bool on_the_way = false;
  double share_of_edge = 0;  ///< where on the first and last edge a person starts and ends
};

/// The edge on which a traveller is after a share of its trip's duration, among those long enough
/// to appear on.
std::size_t edge_on_the_way(const RoadNetwork& road, const TypeDemand& demand,
                            const RoutedTrip& trip, double share) {
  double seconds = share * trip.duration, left = trip.length;
  std::size_t best = 0;
  for (std::size_t i = 0; i + 1 < trip.edges.size(); ++i) {
    const std::size_t edge = index_of(road.edge_by_name.at(trip.edges[i]));
    if (left < 60.0 && i > 0) break;  // it should stay for a while
    if (demand.graph.length[edge] >= demand.type->length + 8.0 || demand.walks) best = i;
    seconds -= edge_duration(demand, edge);
    left -= demand.graph.length[edge];
    if (seconds < 0) break;
  }
  return best;
}

/// What a vehicle takes of a lane's end, in cars.
double car_units(const AgentType& type) {
  if (has_own_pace(type)) return 0.4;
  if (type.sumo_class == "motorcycle") return 0.5;
  return type.length > 7.0 ? 2.0 : 1.0;
}

/// How many of a type are alive on all of the map, with its trips weighed as they are in `pool`.
double alive(const DemandRequest& request, const TypeDemand& demand, const TripPool& pool) {
  const double asked = static_cast<double>(request.agents) * demand.report.share;
  return request.window ? asked * mean_duration(pool) / mean_inside(pool) : asked;
}

/// How many of each type are alive while so many are asked for.
void share_out(const DemandRequest& request, std::vector<TypeDemand>& demands) {
  double total_share = 0;
  for (const TypeDemand& demand : demands) total_share += demand.report.share;
  for (TypeDemand& demand : demands) {
    TripPool& pool = demand.pool;
    if (total_share > 0) demand.report.share /= total_share;
    // those who keep their own pace lose little to others
    pool.slowness = has_own_pace(*demand.type) ? 1 + (request.slowness - 1) / 3 : request.slowness;
    pool.car_units = car_units(*demand.type);
    if (pool.fixed) {  // weights are departures an hour
      pool.agents = total_weight(pool) / 3600 * mean_duration(pool);
      continue;
    }
    pool.agents = alive(request, demand, pool);
  }
}

/// How often each trip is driven, so that the roads carry it and what was counted is met.
BusiestLane weigh(const RoadNetwork& road, const DemandRequest& request,
                  std::vector<TypeDemand>& demands, DemandReport& report) {
  share_out(request, demands);
  std::vector<TripPool> pools;
  for (TypeDemand& demand : demands) pools.push_back(std::move(demand.pool));
  BusiestLane busiest = weigh_trips(road, pools);
  for (std::size_t i = 0; i < demands.size(); ++i)
    if (!pools[i].fixed) pools[i].agents = alive(request, demands[i], pools[i]);
  if (!request.counts.empty()) {
    std::vector<TripPool*> vehicles;
    for (std::size_t i = 0; i < demands.size(); ++i)
      if (!demands[i].walks) vehicles.push_back(&pools[i]);
    report.counts = fit_counts(request.counts, vehicles);
    busiest = busiest_lane(road, pools);
  }
  for (const TripPool& pool : pools) report.agents += pool.agents;
  for (std::size_t i = 0; i < demands.size(); ++i) {
    TypeDemand& demand = demands[i];
    demand.pool = std::move(pools[i]);
    if (request.asks_for_more()) demand.report.share = demand.pool.agents / report.agents;
    demand.report.mean_duration = mean_duration(demand.pool);
    demand.report.mean_length = mean_length(demand.pool);
  }
  return busiest;
}

std::vector<Departure> schedule(const RoadNetwork& road, const DemandRequest& request,
                                std::vector<TypeDemand>& demands, DemandReport& report) {
  std::vector<Departure> departures;
  double owed = 0;  // carries the fraction of an agent from type to type, so that the sum is exact
  for (std::size_t i = 0; i < demands.size(); ++i) {
    TypeDemand& demand = demands[i];
    if (demand.pool.agents <= 0) continue;  // counts leave nobody
    DemandDraws draws(request.seed, 1000 + i);
    owed += demand.pool.agents * activity_at(request, 0);
    const long initial = std::lround(std::floor(owed + 1e-9));
    owed -= static_cast<double>(initial);
    // a running city holds long trips more often than short ones: by duration, uniformly along it
    std::vector<double> by_weight, by_duration;
    double weights = 0, durations = 0;
    for (const RoutedTrip& trip : demand.pool.trips) {
      by_weight.push_back(weights += trip.weight);
      by_duration.push_back(durations += trip.weight * trip.duration);
    }
    for (long k = 0; k < initial; ++k) {
      Departure departure{draws.uniform(0, request.warm_up),
                          i,
                          draws.weighted(by_duration),
                          0,
                          true,
                          draws.uniform()};
      departure.first =
          edge_on_the_way(road, demand, demand.pool.trips[departure.trip], draws.uniform());
      departures.push_back(departure);
    }
    report.initial += initial;
    const double interval = demand.report.mean_duration / demand.pool.agents;
    double time = interval * draws.uniform();
    for (std::size_t k = 0; time < request.duration; ++k) {
      // each of an even stream comes with the share of the hour's activity
      if (request.profile.empty() || draws.uniform() < activity_at(request, time))
        departures.push_back({time, i, draws.weighted(by_weight), 0, false, draws.uniform()});
      time += interval * draws.uniform(0.5, 1.5);
    }
  }
  std::stable_sort(departures.begin(), departures.end(),
                   [](const Departure& a, const Departure& b) { return a.time < b.time; });
  return departures;
}

void append_departure(pugi::xml_node root, const RoadNetwork& road, const TypeDemand& demand,
                      const Departure& departure, const std::string& id) {
  const RoutedTrip& trip = demand.pool.trips[departure.trip];
  const std::span<const std::string> edges = std::span(trip.edges).subspan(departure.first);
  std::string names;
  for (const std::string& edge : edges) names += (names.empty() ? "" : " ") + edge;
  pugi::xml_node element = root.append_child(demand.walks ? "person" : "vehicle");
  auto set = [](pugi::xml_node node, const char* key, const std::string& value) {
    node.append_attribute(key) = value.c_str();
  };
  set(element, "id", id);
  set(element, "type", demand.type->name);
  set(element, "depart", fixed(departure.time));
  if (demand.walks) {
    const auto at = [&](const std::string& edge) {
      return fixed(departure.share_of_edge *
                   demand.graph.length[index_of(road.edge_by_name.at(edge))]);
    };
    set(element, "departPos", at(edges.front()));
    pugi::xml_node walk = element.append_child("walk");
    set(walk, "edges", names);
    set(walk, "arrivalPos", at(edges.back()));
    return;
  }
  set(element, "departLane", "best");
  set(element, "departPos", departure.on_the_way ? "random_free" : "base");
  set(element, "departSpeed", "max");
  set(element.append_child("route"), "edges", names);
}

/// Buses and riders, and the types that they are of.
struct LineTraffic {
  std::vector<const AgentType*> types;
  DemandRequest request;  ///< with what buses can drive alone; runs point into it
  std::vector<BusRun> runs;
  std::vector<Rider> riders;
};

LineTraffic line_traffic(const RoadNetwork& road, const AgentTypeTable& types,
                         const DemandRequest& request, DemandReport& report) {
  LineTraffic traffic;
  traffic.request = request;
  if (!request.transport) return traffic;
  if (request.transport->transport.parts.empty()) {
    report.transport.problem = "the map has no line with two stops on roads that a bus may use";
    return traffic;
  }
  const auto type = [&](const char* name) { return &type_of(types, find_agent_type(types, name)); };
  traffic.types = {type("bus"), type("pedestrian")};
  std::vector<LinePart>& parts = traffic.request.transport->transport.parts;
  parts = drivable_parts(road, *type("bus"), parts, report.transport);
  traffic.runs = line_timetable(road, *type("bus"), traffic.request, report.transport);
  if (traffic.runs.empty())
    report.transport.problem = "no part of a line on which a bus can drive and departs in time";
  traffic.riders = draw_riders(road, types, traffic.request, traffic.runs, report);
  report.transport.riders = static_cast<long>(traffic.riders.size());
  return traffic;
}

/// Adds those of lines to the agents alive.
void count_line_traffic(const DemandRequest& request, DemandReport& report) {
  constexpr double kRide = 900.0;  // on foot, waiting and riding [s]
  const double riders =
      static_cast<double>(report.transport.riders) * std::min(1.0, kRide / request.duration);
  const double others = report.agents;
  report.agents += report.transport.alive + riders;
  report.on_foot = (report.on_foot * others + riders) / report.agents;
  report.departures += report.transport.buses + report.transport.riders;
  report.initial += report.transport.initial;
}

void write_routes(const RoadNetwork& road, const DemandRequest& request,
                  std::vector<TypeDemand>& demands, const std::vector<Departure>& departures,
                  const LineTraffic& lines) {
  pugi::xml_document document, others;
  pugi::xml_node root = document.append_child("routes");
  for (const TypeDemand& demand : demands) append_vehicle_type(root, *demand.type);
  for (const AgentType* const type : lines.types)
    if (std::none_of(demands.begin(), demands.end(),
                     [&](const TypeDemand& demand) { return demand.type == type; }))
      append_vehicle_type(root, *type);
  append_transport(others.append_child("routes"), road, lines.request, lines.runs, lines.riders);
  pugi::xml_node next = others.child("routes").first_child();
  const auto append_until = [&](double time) {
    for (; next && next.attribute("depart").as_double() <= time; next = next.next_sibling())
      root.append_copy(next);
  };
  for (const Departure& departure : departures) {
    TypeDemand& demand = demands[departure.demand];
    append_until(departure.time);
    append_departure(root, road, demand, departure,
                     demand.type->name + "." + std::to_string(demand.report.departures));
    ++demand.report.departures;
  }
  append_until(request.duration);
  if (!document.save_file(request.routes.c_str(), "  "))
    throw Error(request.routes.string(), "cannot be written: is the disk full?");
}

}  // namespace

std::vector<DemandShare> default_demand_mix() {
  return {{"car", 0.40},        {"van", 0.06},     {"bus", 0.04},       {"truck", 0.05},
          {"motorcycle", 0.10}, {"bicycle", 0.12}, {"pedestrian", 0.23}};
}

double activity_at(const DemandRequest& request, double time) {
  if (request.profile.empty()) return 1;
  const double part = time / request.duration * static_cast<double>(request.profile.size());
  const auto index = std::min(static_cast<std::size_t>(part), request.profile.size() - 1);
  return request.profile[index] / *std::max_element(request.profile.begin(), request.profile.end());
}

DemandReport generate_demand(const RoadNetwork& road, const AgentTypeTable& types,
                             const DemandRequest& request) {
  // what the router refuses, or what doesn't lead through the window, is drawn again
  const int rounds = request.window ? 10 : 3;
  DemandReport report;
  std::vector<TypeDemand> demands = type_demands(road, types, request, report);
  for (int round = 0; round < rounds; ++round) {
    for (TypeDemand& demand : demands) demand.drawn.clear();
    draw_trips(demands, request.seed, request.min_distance, round);
    if (round == 0) ask_for_trips(road, request, demands);
    const bool any = std::any_of(demands.begin(), demands.end(),
                                 [](const TypeDemand& demand) { return !demand.drawn.empty(); });
    if (!any) break;
    if (!route_trips(road, request, demands, report)) {
      report.stopped = true;
      return report;
    }
    if (!request.window) continue;
    for (TypeDemand& demand : demands)
      if (!demand.pool.fixed) keep_trips_through(road, *request.window, demand);
  }
  for (TypeDemand& demand : demands) {
    demand.report.trips_routable = static_cast<long>(demand.pool.trips.size());
    if (demand.pool.fixed)
      report.unroutable += demand.report.trips_drawn - demand.report.trips_routable;
    if (!demand.pool.trips.empty()) continue;
    demand.report.problem = request.window ? "no trip of it leads through the window"
                                           : "no trip of it can be routed: its edges do not join";
    report.types.push_back(demand.report);
  }
  std::erase_if(demands, [](const TypeDemand& demand) { return demand.pool.trips.empty(); });
  if (demands.empty())
    throw Error(request.name.empty() ? request.network.string() : request.name,
                "nobody can travel on what there is of it: no kind of traffic has two roads or "
                "paths of which one leads onto the other; import more of the place");

  const BusiestLane busiest = weigh(road, request, demands, report);
  if (busiest.lane != kNoLane) report.busiest_lane = road.lane(busiest.lane).name;
  report.busiest_load = busiest.load;
  const std::vector<Departure> departures = schedule(road, request, demands, report);
  const LineTraffic lines = line_traffic(road, types, request, report);
  if (report.stopped) return report;
  write_routes(road, request, demands, departures, lines);
  report.departures = static_cast<long>(departures.size());
  for (const TypeDemand& demand : demands) {
    report.types.push_back(demand.report);
    if (demand.walks) report.on_foot += demand.report.share;
  }
  if (request.transport) count_line_traffic(request, report);
  return report;
}

}  // namespace sumogamma
