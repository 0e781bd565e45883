#include "demand/trip_routing.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <span>
#include <string_view>

#include "base/error.h"
#include "base/subprocess.h"
#include "demand/route_fit.h"
#include "demand/vehicle_type_xml.h"

namespace sumogamma {
namespace {

void append_trip(pugi::xml_node root, const RoadNetwork& road, const TypeDemand& demand,
                 std::size_t row) {
  const TripEnds& trip = demand.drawn[row];
  const std::string id = demand.type->name + "." + std::to_string(row);
  pugi::xml_node element = root.append_child(demand.walks ? "person" : "trip");
  element.append_attribute("id") = id.c_str();
  element.append_attribute("type") = demand.type->name.c_str();
  element.append_attribute("depart") = "0";
  pugi::xml_node ends = demand.walks ? element.append_child("personTrip") : element;
  ends.append_attribute("from") = road.edges[trip.from].name.c_str();
  ends.append_attribute("to") = road.edges[trip.to].name.c_str();
  if (trip.via != TripEnds::kNowhere)
    ends.append_attribute("via") = road.edges[trip.via].name.c_str();
}

std::vector<std::string> words(std::string_view text) {
  std::vector<std::string> result;
  while (!text.empty()) {
    const std::size_t blank = text.find(' ');
    if (blank != 0) result.emplace_back(text.substr(0, blank));
    text = blank == std::string_view::npos ? std::string_view() : text.substr(blank + 1);
  }
  return result;
}

/// Seconds lost at the junction between two edges: at a signal half a red of a usual program, where
/// the way must be given some of a gap.
double junction_delay(const RoadNetwork& road, EdgeId from, EdgeId to, VehicleClassMask mask) {
  for (const LaneId lane : road.edge(from).lanes)
    for (const ConnectionId id : road.lane(lane).outgoing) {
      const Connection& connection = road.connection(id);
      if (road.lane(connection.to).edge != to) continue;
      if ((road.lane(connection.to).allowed & mask) == 0) continue;
      if (connection.signal != kNoSignal) return 12.0;
      return connection.priority == LinkPriority::Major ? 0.0 : 1.5;
    }
  return 0;
}

/// Ways from edge to edge that a class may take, one a lane.
std::vector<ConnectionId> ways_between(const RoadNetwork& road, EdgeId from, EdgeId to,
                                       VehicleClassMask mask) {
  std::vector<ConnectionId> ways;
  for (const LaneId lane : road.edge(from).lanes) {
    const auto& outgoing = road.lane(lane).outgoing;
    const auto found = std::find_if(outgoing.begin(), outgoing.end(), [&](ConnectionId id) {
      return leads_onto(road, id, to, mask);
    });
    if (found != outgoing.end()) ways.push_back(*found);
  }
  return ways;
}

/// Length of a route, how long it takes with nobody else on the road, and the ways over its
/// junctions.
void measure(const RoadNetwork& road, const TypeDemand& demand, std::span<const EdgeId> route,
             RoutedTrip& trip) {
  const VehicleClassMask mask = vehicle_class_from_name(demand.type->sumo_class);
  for (std::size_t i = 0; i < route.size(); ++i) {
    const std::size_t edge = index_of(route[i]);
    trip.length += demand.graph.length[edge];
    trip.times.push_back(edge_duration(demand, edge));
    trip.duration += trip.times.back();
    if (i == 0 || demand.walks) continue;
    const double lost = junction_delay(road, route[i - 1], route[i], mask);
    trip.times.back() += lost;
    trip.duration += lost;
    trip.steps.push_back(ways_between(road, route[i - 1], route[i], mask));
  }
}

/// The edges of a route; none where one isn't there for the type.
std::vector<EdgeId> route_over(const RoadNetwork& road, const TypeDemand& demand,
                               const std::vector<std::string>& names) {
  std::vector<EdgeId> route;
  for (const std::string& name : names) {
    const auto edge = road.edge_by_name.find(name);
    if (edge == road.edge_by_name.end() ||
        (!demand.walks && !demand.graph.usable[index_of(edge->second)]))
      return {};
    route.push_back(edge->second);
  }
  return route;
}

void take_routes(const RoadNetwork& road, const std::filesystem::path& file,
                 std::vector<TypeDemand>& demands) {
  pugi::xml_document document;
  if (!document.load_file(file.c_str()))
    throw Error(file.string(), "the router's output is not readable");
  std::map<std::string, TypeDemand*, std::less<>> by_name;
  for (TypeDemand& demand : demands) by_name[demand.type->name] = &demand;
  for (const pugi::xml_node element : document.document_element().children()) {
    const std::string_view id = element.attribute("id").value();
    const auto found = by_name.find(id.substr(0, std::min(id.find('.'), id.size())));
    if (found == by_name.end()) continue;
    TypeDemand& demand = *found->second;
    // a person whose trip has more than one stage, or none, did not simply walk
    const pugi::xml_node route = element.child(demand.walks ? "walk" : "route");
    if (!route || (demand.walks && route.next_sibling("walk"))) continue;
    RoutedTrip trip;
    trip.edges = words(route.attribute("edges").value());
    const std::vector<EdgeId> edges = route_over(road, demand, trip.edges);
    if (edges.size() < (demand.walks ? 2u : 1u) || turns_back(road, edges)) continue;
    if (!demand.walks && !suits(road, *demand.type, edges)) continue;
    measure(road, demand, edges, trip);
    trip.weight = demand.drawn.at(std::stoul(std::string(id.substr(id.find('.') + 1)))).weight;
    demand.pool.trips.push_back(std::move(trip));
  }
}

}  // namespace

double edge_duration(const TypeDemand& demand, std::size_t edge) {
  const double own =
      has_own_pace(*demand.type) ? demand.type->preferred_speed : demand.type->max_speed;
  return demand.graph.length[edge] / std::max(0.5, std::min(demand.graph.speed[edge], own));
}

bool route_trips(const RoadNetwork& road, const DemandRequest& request,
                 std::vector<TypeDemand>& demands, DemandReport& report) {
  const std::filesystem::path trips = request.work / "trips.xml",
                              routes = request.work / "routed.rou.xml";
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("routes");
  for (const TypeDemand& demand : demands) append_vehicle_type(root, *demand.type);
  for (const TypeDemand& demand : demands)
    for (std::size_t row = 0; row < demand.drawn.size(); ++row)
      append_trip(root, road, demand, row);
  if (!document.save_file(trips.c_str(), ""))
    throw Error(trips.string(), "cannot be written: is the disk full?");

  const std::filesystem::path program = find_program("duarouter");
  if (program.empty())
    throw Error("duarouter",
                "not found in $SUMO_HOME/bin or PATH: install SUMO (apt install sumo)");
  ProcessRequest process;
  process.arguments = {program.string(),
                       "-n",
                       request.network.string(),
                       "-r",
                       trips.string(),
                       "-o",
                       routes.string(),
                       "--alternatives-output",
                       "/dev/null",
                       "--ignore-errors",
                       "--no-step-log",
                       "--no-warnings",
                       "--xml-validation",
                       "never",
                       "--xml-validation.net",
                       "never",
                       "--seed",
                       "1"};
  process.time_limit = 1800.0;
  process.should_stop = request.should_stop;
  const ProcessResult result = run_process(process);
  report.router += result.errors + result.output;
  if (result.stopped) return false;
  if (!result.ok() || !std::filesystem::exists(routes))
    throw Error("duarouter",
                describe_end(result, process.time_limit) + ": " + result.errors.substr(0, 300));
  take_routes(road, routes, demands);
  std::filesystem::remove(trips);
  std::filesystem::remove(routes);
  return true;
}

}  // namespace sumogamma
