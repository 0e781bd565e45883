#include "study/demand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <pugixml.hpp>
#include <queue>
#include <span>
#include <string_view>

#include "base/error.h"
#include "base/random.h"
#include "base/subprocess.h"
#include "base/units.h"
#include "scene/sumo_defaults.h"
#include "study/trip_weights.h"

namespace sumogamma {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRimPreference =
    10.0;  // how much likelier a trip starts or ends at the network's rim
constexpr std::size_t kOrigins = 200;  // distinct origins of a type, each searched once
constexpr long kPoolTotal = 2500;  // routed trips, shared out by type; departures draw from them
constexpr long kPoolLeast = 120;

/// The demand's own stream of draws: the n-th draw is a pure function of seed and n.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}
  double uniform() { return random_uniform(seed_, stream_, counter_++, Draw::Demand); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  std::size_t index(std::size_t count) {
    return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
  }
  /// Index drawn by weight; cumulative must be increasing with a positive end.
  std::size_t weighted(const std::vector<double>& cumulative) {
    const double at = uniform() * cumulative.back();
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), at);
    return std::min(static_cast<std::size_t>(found - cumulative.begin()), cumulative.size() - 1);
  }

 private:
  std::uint64_t seed_, stream_, counter_ = 0;
};

/// What one vehicle class sees of the network.
struct ClassGraph {
  std::vector<std::size_t> edges;              ///< usable, by index in the network
  std::vector<bool> usable;                    ///< the same, by index
  std::vector<std::vector<std::size_t>> next;  ///< by network edge: edges that follow
  std::vector<int> entries;  ///< by network edge: how many lead into it, turn-arounds left out
  std::vector<double> length, speed;  ///< by network edge [m], [m/s]

  /// Nothing leads to it or on from it: a road that crosses the map, or a rest of one at its edge.
  bool stands_alone(std::size_t edge) const { return entries[edge] == 0 && next[edge].empty(); }
};

void link_vehicles(const RoadNetwork& road, VehicleClassMask mask, ClassGraph& graph) {
  for (const std::size_t edge : graph.edges)
    for (const LaneId lane : road.edges[edge].lanes) {
      if ((road.lane(lane).allowed & mask) == 0) continue;
      for (const ConnectionId id : road.lane(lane).outgoing) {
        const Connection& connection = road.connection(id);
        const Lane& target = road.lane(connection.to);
        if ((target.allowed & mask) == 0 || !graph.usable[index_of(target.edge)]) continue;
        graph.next[edge].push_back(index_of(target.edge));
        if (connection.direction != 't') ++graph.entries[index_of(target.edge)];
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

/// Edges and ways on for a class; `narrow`: with streets that are too narrow for it, too.
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

/// Metres from the start of the origin to the end of each edge; infinity where there is no way
/// (Dijkstra).
std::vector<double> distances_from(const ClassGraph& graph, std::size_t origin) {
  std::vector<double> distance(graph.length.size(), kInfinity);
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

/// Edges between which somebody travels.
struct Trip {
  std::size_t from = 0, to = 0;
};

/// Everything about one type while demand is made.
struct TypeWork {
  const AgentType* type = nullptr;
  bool walks = false;
  ClassGraph graph;
  std::vector<Trip> drawn;
  TripPool pool;  ///< of those that the router found ways for
  DemandByType report;
};

/// Draws origin-destination pairs: both by edge length, the rim preferred, at least so far apart.
/// Trips begin and end on the same edge only where that stands alone, or all may with
/// `within_edge`. An edge that stands alone counts by its length: preferred as rim, 200 m of road
/// that a cut-out had left joined to nothing took every fifth car of a map.
class TripDraw {
 public:
  TripDraw(const TypeWork& work, std::uint64_t seed, std::uint64_t stream, double min_distance,
           bool within_edge)
      : graph_(work.graph),
        walks_(work.walks),
        within_edge_(within_edge),
        draws_(seed, stream),
        least_edge_(work.walks ? 2.0 : work.type->length + 3.0) {
    std::vector<double> cumulative;
    std::vector<std::size_t> candidates;
    double total = 0;
    for (const std::size_t edge : graph_.edges) {
      if (graph_.length[edge] < least_edge_) continue;
      const bool rim = graph_.entries[edge] == 0 && !graph_.stands_alone(edge);
      total += graph_.length[edge] * (rim ? kRimPreference : 1.0);
      cumulative.push_back(total);
      candidates.push_back(edge);
    }
    // every other origin may lie at a dead end of the cut-out: ask more often than origins are
    // wanted
    for (std::size_t attempt = 0;
         !candidates.empty() && attempt < 3 * kOrigins && origins_.size() < kOrigins; ++attempt)
      add_origin(candidates[draws_.weighted(cumulative)], min_distance);
  }
  bool empty() const { return origins_.empty(); }
  Trip draw() {
    const Origin& origin = origins_[draws_.index(origins_.size())];
    return {origin.edge, origin.targets[draws_.weighted(origin.cumulative)]};
  }

 private:
  struct Origin {
    std::size_t edge = 0;
    std::vector<std::size_t> targets;
    std::vector<double> cumulative;
  };
  void add_origin(std::size_t edge, double min_distance) {
    if (const auto known = searched_.find(edge); known != searched_.end()) {
      if (known->second < origins_.size()) origins_.push_back(Origin(origins_[known->second]));
      return;
    }
    const std::vector<double> distance = distances_from(graph_, edge);
    Origin origin{edge, {}, {}};
    double total = 0;
    for (const std::size_t target : graph_.edges) {
      if (graph_.length[target] < least_edge_) continue;
      if (target == edge && (walks_ || !(within_edge_ || graph_.stands_alone(edge)))) continue;
      if (!(distance[target] >= min_distance) || distance[target] == kInfinity) continue;
      const bool rim = graph_.next[target].empty();
      total += graph_.length[target] * (rim ? kRimPreference : 1.0);
      origin.targets.push_back(target);
      origin.cumulative.push_back(total);
    }
    searched_[edge] =
        origin.targets.empty() ? std::numeric_limits<std::size_t>::max() : origins_.size();
    if (!origin.targets.empty()) origins_.push_back(std::move(origin));
  }
  const ClassGraph& graph_;
  bool walks_, within_edge_;
  Draws draws_;
  double least_edge_;
  std::vector<Origin> origins_;
  std::map<std::size_t, std::size_t> searched_;
};

std::string number(double value, int decimals = 2) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// A vType's speedFactor: normal about `mean`, its deviation and bounds as shares of that.
std::string normal_factor(double mean, double deviation, double least, double most) {
  std::string text = "normc(" + number(mean, 3);
  for (const double share : {deviation, least, most}) text += "," + number(mean * share, 3);
  return text + ")";
}

bool has_own_pace(const AgentType& type) {
  return type.sumo_class == "pedestrian" || type.sumo_class == "bicycle";
}

void append_vehicle_type(pugi::xml_node root, const AgentType& type) {
  pugi::xml_node element = root.append_child("vType");
  auto set = [&](const char* key, const std::string& value) {
    element.append_attribute(key) = value.c_str();
  };
  const bool slow = has_own_pace(type);
  set("id", type.name);
  set("vClass", type.sumo_class);
  set("length", number(type.length));
  set("width", number(type.width));
  set("minGap", number(type.min_gap));
  // people on foot and on bicycles differ in the speed they like, others in how they take the
  // limit; SUMO tells nobody the desiredMaxSpeed of people: it stays the default, and the factor
  // says more
  const bool on_foot = type.sumo_class == "pedestrian";
  if (!on_foot) set("maxSpeed", number(slow ? type.preferred_speed * 1.6 : type.max_speed));
  if (slow && !on_foot) set("desiredMaxSpeed", number(type.preferred_speed));
  const double mean = on_foot ? type.preferred_speed / kWalkingSpeed : 1.0;
  set("speedFactor", slow ? normal_factor(mean, 0.15, 0.6, 1.5) : normal_factor(1, 0.1, 0.7, 1.3));
}

void append_trip(pugi::xml_node root, const RoadNetwork& road, const TypeWork& work,
                 std::size_t row) {
  const Trip& trip = work.drawn[row];
  const std::string id = work.type->name + "." + std::to_string(row);
  pugi::xml_node element = root.append_child(work.walks ? "person" : "trip");
  element.append_attribute("id") = id.c_str();
  element.append_attribute("type") = work.type->name.c_str();
  element.append_attribute("depart") = "0";
  pugi::xml_node ends = work.walks ? element.append_child("personTrip") : element;
  ends.append_attribute("from") = road.edges[trip.from].name.c_str();
  ends.append_attribute("to") = road.edges[trip.to].name.c_str();
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

/// At the road's limit, which drivers keep; people on foot and on bicycles at their own speed.
double edge_duration(const TypeWork& work, std::size_t edge) {
  const double own = has_own_pace(*work.type) ? work.type->preferred_speed : work.type->max_speed;
  return work.graph.length[edge] / std::max(0.5, std::min(work.graph.speed[edge], own));
}

/// Seconds lost at the junction between two edges: at a signal half a red of a usual program, where
/// the way must be given some of a gap.
double junction_delay(const RoadNetwork& road, const Edge& from, const Edge& to,
                      VehicleClassMask mask) {
  for (const LaneId lane : from.lanes)
    for (const ConnectionId id : road.lane(lane).outgoing) {
      const Connection& connection = road.connection(id);
      if (road.lane(connection.to).edge != road.lane(to.lanes[0]).edge) continue;
      if ((road.lane(connection.to).allowed & mask) == 0) continue;
      if (connection.signal != kNoSignal) return 12.0;
      return connection.state == 'M' ? 0.0 : 1.5;
    }
  return 0;
}

/// Ways from edge to edge that a class may take, one a lane.
std::vector<ConnectionId> ways_between(const RoadNetwork& road, const Edge& from, const Edge& to,
                                       VehicleClassMask mask) {
  std::vector<ConnectionId> ways;
  for (const LaneId lane : from.lanes) {
    const auto& outgoing = road.lane(lane).outgoing;
    const auto found = std::find_if(outgoing.begin(), outgoing.end(), [&](ConnectionId id) {
      const Lane& target = road.lane(road.connection(id).to);
      return target.edge == road.lane(to.lanes[0]).edge &&
             (target.allowed & road.lane(lane).allowed & mask) != 0;
    });
    if (found != outgoing.end()) ways.push_back(*found);
  }
  return ways;
}

/// Length of a route, how long it takes with nobody else on the road, and the ways over its
/// junctions.
void measure(const RoadNetwork& road, const TypeWork& work, RoutedTrip& trip) {
  const VehicleClassMask mask = vehicle_class_from_name(work.type->sumo_class);
  const Edge* before = nullptr;
  for (const std::string& name : trip.edges) {
    const std::size_t edge = index_of(road.edge_by_name.at(name));
    trip.length += work.graph.length[edge];
    trip.duration += edge_duration(work, edge);
    if (before && !work.walks) {
      trip.duration += junction_delay(road, *before, road.edges[edge], mask);
      trip.steps.push_back(ways_between(road, *before, road.edges[edge], mask));
    }
    before = &road.edges[edge];
  }
}

/// A trip that turns back on its own road. On foot SUMO finds no way across a dead end; on wheels
/// it is a U-turn in a cut-off street that nobody would drive.
bool turns_back(const RoadNetwork& road, const std::vector<std::string>& edges) {
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    if (are_opposite(road.edge(road.edge_by_name.at(edges[i])),
                     road.edge(road.edge_by_name.at(edges[i + 1]))))
      return true;
  }
  return false;
}

/// Sharpest turn that a body of this length gets round from lane to lane without swinging out over
/// others [rad].
double sharpest_turn(double length) {
  if (length < 3.0) return kPi;
  return length < 5.5 ? radians(130.0) : length < 6.5 ? radians(115.0) : radians(100.0);
}

/// True where every turn of the route suits the type's length.
bool turns_suit(const RoadNetwork& road, const std::vector<std::string>& edges, double length) {
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

void take_routes(const RoadNetwork& road, const std::filesystem::path& file,
                 std::vector<TypeWork>& works) {
  pugi::xml_document document;
  if (!document.load_file(file.c_str()))
    throw Error(file.string(), "the router's output is not readable");
  std::map<std::string, TypeWork*, std::less<>> by_name;
  for (TypeWork& work : works) by_name[work.type->name] = &work;
  for (const pugi::xml_node element : document.document_element().children()) {
    const std::string_view id = element.attribute("id").value();
    const auto found = by_name.find(id.substr(0, std::min(id.find('.'), id.size())));
    if (found == by_name.end()) continue;
    TypeWork& work = *found->second;
    // a person whose trip has more than one stage, or none, did not simply walk
    const pugi::xml_node route = element.child(work.walks ? "walk" : "route");
    if (!route || (work.walks && route.next_sibling("walk"))) continue;
    RoutedTrip trip;
    trip.edges = words(route.attribute("edges").value());
    const bool known =
        std::all_of(trip.edges.begin(), trip.edges.end(), [&](const std::string& name) {
          const auto edge = road.edge_by_name.find(name);
          return edge != road.edge_by_name.end() &&
                 (work.walks || work.graph.usable[index_of(edge->second)]);
        });
    if (trip.edges.size() < (work.walks ? 2u : 1u) || !known) continue;
    if (turns_back(road, trip.edges)) continue;
    if (!work.walks && !turns_suit(road, trip.edges, work.type->length)) continue;
    measure(road, work, trip);
    work.pool.trips.push_back(std::move(trip));
  }
}

/// Has the router make routes of all drawn trips; false where it was stopped.
bool route_trips(const RoadNetwork& road, const DemandRequest& request,
                 std::vector<TypeWork>& works, DemandReport& report) {
  const std::filesystem::path trips = request.work / "trips.xml",
                              routes = request.work / "routed.rou.xml";
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("routes");
  for (const TypeWork& work : works) append_vehicle_type(root, *work.type);
  for (const TypeWork& work : works)
    for (std::size_t row = 0; row < work.drawn.size(); ++row) append_trip(root, road, work, row);
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
  take_routes(road, routes, works);
  std::filesystem::remove(trips);
  std::filesystem::remove(routes);
  return true;
}

std::vector<TypeWork> type_works(const RoadNetwork& road, const AgentTypeTable& types,
                                 const DemandRequest& request, DemandReport& report) {
  std::vector<TypeWork> works;
  for (const DemandShare& share : request.mix) {
    if (!(share.share > 0)) continue;
    TypeWork work;
    work.type = &type_of(types, find_agent_type(types, share.type));
    work.walks = work.type->sumo_class == "pedestrian";
    work.report.type = share.type;
    work.report.share = share.share;
    work.graph = class_graph(road, vehicle_class_from_name(work.type->sumo_class), false);
    if (work.graph.edges.empty()) {
      work.report.problem = "no edge of the network lets it travel";
      report.types.push_back(work.report);
      continue;
    }
    works.push_back(std::move(work));
  }
  return works;
}

/// A type's trips, as far apart as the map allows; within one edge only where there are no others,
/// or the router refused all of them.
std::vector<Trip> draw_type(const TypeWork& work, std::uint64_t seed, std::uint64_t stream,
                            double min_distance, long count) {
  std::vector<Trip> trips;
  const bool refused = work.report.trips_drawn > 0 && work.pool.trips.empty();
  for (double distance = min_distance; distance > 5.0; distance /= 2)
    for (const bool within_edge : {refused, true}) {
      TripDraw draw(work, seed, stream, distance, within_edge);
      if (draw.empty()) continue;
      for (long k = 0; k < count; ++k) trips.push_back(draw.draw());
      return trips;
    }
  return trips;
}

void draw_trips(const DemandRequest& request, std::vector<TypeWork>& works, int round) {
  double total = 0;
  for (const TypeWork& work : works) total += work.report.share;
  for (std::size_t i = 0; i < works.size(); ++i) {
    TypeWork& work = works[i];
    const long wanted = std::max(
        kPoolLeast, std::lround(static_cast<double>(kPoolTotal) * work.report.share / total));
    const long missing = wanted - static_cast<long>(work.pool.trips.size());
    work.drawn = draw_type(work, request.seed, static_cast<std::uint64_t>(round) * 100 + i,
                           request.min_distance, std::max(missing, 0L));
    work.report.trips_drawn += static_cast<long>(work.drawn.size());
  }
}

struct Departure {
  double time = 0;
  std::size_t work = 0;   ///< row of the type
  std::size_t trip = 0;   ///< row of its routed trip
  std::size_t first = 0;  ///< edge of the route that it starts on
  bool on_the_way = false;
  double share_of_edge = 0;  ///< where on the first and last edge a person starts and ends
};

/// The edge on which a traveller is after a share of its trip's duration, among those long enough
/// to appear on.
std::size_t edge_on_the_way(const RoadNetwork& road, const TypeWork& work, const RoutedTrip& trip,
                            double share) {
  double seconds = share * trip.duration, left = trip.length;
  std::size_t best = 0;
  for (std::size_t i = 0; i + 1 < trip.edges.size(); ++i) {
    const std::size_t edge = index_of(road.edge_by_name.at(trip.edges[i]));
    if (left < 60.0 && i > 0) break;  // it should stay for a while
    if (work.graph.length[edge] >= work.type->length + 8.0 || work.walks) best = i;
    seconds -= edge_duration(work, edge);
    left -= work.graph.length[edge];
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

/// How many of each type are to be alive, and how often each of its trips is driven.
BusiestLane weigh(const RoadNetwork& road, const DemandRequest& request,
                  std::vector<TypeWork>& works) {
  double total_share = 0;
  for (const TypeWork& work : works) total_share += work.report.share;
  std::vector<TripPool> pools;
  for (TypeWork& work : works) {
    work.report.share /= total_share;
    work.pool.agents = static_cast<double>(request.agents) * work.report.share;
    // those who keep their own pace lose little to others
    work.pool.slowness =
        has_own_pace(*work.type) ? 1 + (request.slowness - 1) / 3 : request.slowness;
    work.pool.car_units = car_units(*work.type);
    pools.push_back(std::move(work.pool));
  }
  const BusiestLane busiest = weigh_trips(road, pools);
  for (std::size_t i = 0; i < works.size(); ++i) {
    TypeWork& work = works[i];
    work.pool = std::move(pools[i]);
    work.report.mean_duration = mean_duration(work.pool);
    double total = 0;
    for (const RoutedTrip& trip : work.pool.trips) total += trip.weight;
    for (const RoutedTrip& trip : work.pool.trips)
      work.report.mean_length += trip.length * trip.weight / total;
  }
  return busiest;
}

std::vector<Departure> schedule(const RoadNetwork& road, const DemandRequest& request,
                                std::vector<TypeWork>& works, DemandReport& report) {
  std::vector<Departure> departures;
  double owed = 0;  // carries the fraction of an agent from type to type, so that the sum is exact
  for (std::size_t i = 0; i < works.size(); ++i) {
    TypeWork& work = works[i];
    Draws draws(request.seed, 1000 + i);
    owed += work.pool.agents;
    const long initial = std::lround(std::floor(owed + 1e-9));
    owed -= static_cast<double>(initial);
    // a running city holds long trips more often than short ones: by duration, uniformly along it
    std::vector<double> by_weight, by_duration;
    double weights = 0, durations = 0;
    for (const RoutedTrip& trip : work.pool.trips) {
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
          edge_on_the_way(road, work, work.pool.trips[departure.trip], draws.uniform());
      departures.push_back(departure);
    }
    report.initial += initial;
    const double interval = work.report.mean_duration / work.pool.agents;
    double time = interval * draws.uniform();
    for (std::size_t k = 0; time < request.duration; ++k) {
      departures.push_back({time, i, draws.weighted(by_weight), 0, false, draws.uniform()});
      time += interval * draws.uniform(0.5, 1.5);
    }
  }
  std::stable_sort(departures.begin(), departures.end(),
                   [](const Departure& a, const Departure& b) { return a.time < b.time; });
  return departures;
}

void append_departure(pugi::xml_node root, const RoadNetwork& road, const TypeWork& work,
                      const Departure& departure, const std::string& id) {
  const RoutedTrip& trip = work.pool.trips[departure.trip];
  const std::span<const std::string> edges = std::span(trip.edges).subspan(departure.first);
  std::string names;
  for (const std::string& edge : edges) names += (names.empty() ? "" : " ") + edge;
  pugi::xml_node element = root.append_child(work.walks ? "person" : "vehicle");
  auto set = [](pugi::xml_node node, const char* key, const std::string& value) {
    node.append_attribute(key) = value.c_str();
  };
  set(element, "id", id);
  set(element, "type", work.type->name);
  set(element, "depart", number(departure.time));
  if (work.walks) {
    const auto at = [&](const std::string& edge) {
      return number(departure.share_of_edge *
                    work.graph.length[index_of(road.edge_by_name.at(edge))]);
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

void write_routes(const RoadNetwork& road, const DemandRequest& request,
                  std::vector<TypeWork>& works, const std::vector<Departure>& departures) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("routes");
  for (const TypeWork& work : works) append_vehicle_type(root, *work.type);
  for (const Departure& departure : departures) {
    TypeWork& work = works[departure.work];
    append_departure(root, road, work, departure,
                     work.type->name + "." + std::to_string(work.report.departures));
    ++work.report.departures;
  }
  if (!document.save_file(request.routes.c_str(), "  "))
    throw Error(request.routes.string(), "cannot be written: is the disk full?");
}

}  // namespace

std::vector<DemandShare> default_demand_mix() {
  return {{"car", 0.40},        {"van", 0.06},     {"bus", 0.04},       {"truck", 0.05},
          {"motorcycle", 0.10}, {"bicycle", 0.12}, {"pedestrian", 0.23}};
}

DemandReport generate_demand(const RoadNetwork& road, const AgentTypeTable& types,
                             const DemandRequest& request) {
  constexpr int kRounds = 3;  // what the router refuses is drawn again
  DemandReport report;
  std::vector<TypeWork> works = type_works(road, types, request, report);
  for (int round = 0; round < kRounds; ++round) {
    draw_trips(request, works, round);
    const bool any =
        std::any_of(works.begin(), works.end(), [](const TypeWork& w) { return !w.drawn.empty(); });
    if (!any) break;
    if (!route_trips(road, request, works, report)) {
      report.stopped = true;
      return report;
    }
  }
  for (TypeWork& work : works) {
    work.report.trips_routable = static_cast<long>(work.pool.trips.size());
    if (!work.pool.trips.empty()) continue;
    work.report.problem = "no trip of it can be routed: its edges do not join";
    report.types.push_back(work.report);
  }
  std::erase_if(works, [](const TypeWork& work) { return work.pool.trips.empty(); });
  if (works.empty())
    throw Error(request.network.string(),
                "nothing can travel on this network: no class has two joined edges");

  const BusiestLane busiest = weigh(road, request, works);
  if (busiest.lane != kNoLane) report.busiest_lane = road.lane(busiest.lane).name;
  report.busiest_load = busiest.load;
  const std::vector<Departure> departures = schedule(road, request, works, report);
  write_routes(road, request, works, departures);
  report.departures = static_cast<long>(departures.size());
  for (const TypeWork& work : works) {
    report.types.push_back(work.report);
    if (work.walks) report.on_foot += work.report.share;
  }
  return report;
}

}  // namespace sumogamma
