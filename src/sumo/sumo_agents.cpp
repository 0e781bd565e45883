#include "sumo/sumo_agents.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/hash.h"
#include "base/random.h"
#include "scene/sumo_defaults.h"

namespace sumogamma {

namespace {

/// The built-in type on the road whose length and width are nearest, in proportion.
AgentTypeId nearest_body(const AgentTypeTable& types, double length, double width) {
  AgentTypeId best = find_agent_type(types, "car");
  double least = std::numeric_limits<double>::infinity();
  if (!(length > 0.0 && width > 0.0)) return best;
  for (const char* name : {"car", "van", "truck", "bus", "motorcycle", "bicycle"}) {
    const AgentTypeId id = find_agent_type(types, name);
    const AgentType& type = type_of(types, id);
    const double apart =
        std::abs(std::log(length / type.length)) + std::abs(std::log(width / type.width));
    if (apart >= least) continue;
    least = apart;
    best = id;
  }
  return best;
}

}  // namespace

namespace {

/// How many edges of its route a vehicle has left behind; none where it isn't known on which it is.
std::size_t begun_edges(const RoadNetwork& network, const SumoAgentDetails& details) {
  const auto lane = network.lane_by_name.find(details.lane);
  const auto index = static_cast<std::size_t>(details.route_index);
  if (details.is_person || lane == network.lane_by_name.end() || index >= details.route.size())
    return 0;
  return network.edge(network.lane(lane->second).edge).name == details.route[index] ? index : 0;
}

/// The halts of a vehicle's plan on edges of its route, in order. Waypoints, which it only passes,
/// are none.
std::vector<RouteStop> route_stops(const RoadNetwork& network, const SumoAgentDetails& details,
                                   const std::vector<EdgeId>& route, const PathRequest& request) {
  std::vector<RouteStop> stops;
  std::size_t at = 0;
  double reached = request.start_along;
  for (std::size_t plan = 0; plan < details.stops.size(); ++plan) {
    const SumoAgentDetails::Stop& stop = details.stops[plan];
    const auto found = network.lane_by_name.find(stop.lane);
    if (stop.speed > 0.0 || found == network.lane_by_name.end()) continue;
    const Lane& lane = network.lane(found->second);
    const double scale = lane.length > 0.0 ? lane.centerline.length() / lane.length : 1.0;
    const double along = stop.end * scale;
    std::size_t index = at;
    while (index < route.size() &&
           (route[index] != lane.edge || (index == at && along < reached - 0.5)))
      ++index;
    if (index == route.size()) continue;
    const bool usable = (lane.allowed & request.vehicle_class) != 0;
    // SUMO: half of its length has to be within the stop
    const double room = std::max((stop.end - stop.start) * scale - 0.5 * details.length, 0.0);
    stops.push_back({index, usable ? lane.index : -1, along, room, static_cast<int>(plan)});
    at = index;
    reached = along;
  }
  return stops;
}

}  // namespace

std::optional<AgentTypeId> agent_type_of(const AgentTypeTable& types,
                                         const SumoAgentDetails& details) {
  for (std::size_t row = 0; row < types.size(); ++row)
    if (types[row].name == details.type_id) return static_cast<AgentTypeId>(row);
  struct ByClass {
    std::string_view sumo_class, type;
  };
  static constexpr ByClass kByClass[] = {{"passenger", "car"},    {"taxi", "car"},
                                         {"delivery", "van"},     {"truck", "truck"},
                                         {"trailer", "truck"},    {"bus", "bus"},
                                         {"coach", "bus"},        {"motorcycle", "motorcycle"},
                                         {"moped", "motorcycle"}, {"bicycle", "bicycle"},
                                         {"tram", "tram"},        {"ship", "ship"}};
  if (details.is_person) return find_agent_type(types, "pedestrian");
  for (const ByClass& row : kByClass)
    if (row.sumo_class == details.vehicle_class) return find_agent_type(types, row.type);
  // what says who may use a lane, not which body comes: emergency, evehicle, hov, custom1, ...
  const VehicleClassMask mask = vehicle_class_from_name(details.vehicle_class);
  if ((mask & vehicle_class::kOnRails) != 0 && details.vehicle_class != "ignoring")
    return find_agent_type(types, "train");
  if ((mask & vehicle_class::kMotor) == 0) return std::nullopt;
  return nearest_body(types, details.length, details.width);
}

std::shared_ptr<Path> path_of(const Model& model, const SumoAgentDetails& details,
                              AgentTypeId type_id, std::string& why, const SpeedLimits& limits) {
  const RoadNetwork& network = model.road;
  const AgentType& type = type_of(model.types, type_id);
  std::vector<EdgeId> route;
  const std::size_t begun = begun_edges(network, details);
  for (const std::string& name : std::span(details.route).subspan(begun)) {
    const auto edge = network.edge_by_name.find(name);
    if (edge == network.edge_by_name.end()) {
      why = "edge '" + name + "' is not in the network file";
      return nullptr;
    }
    route.push_back(edge->second);
  }
  PathRequest request;
  request.route = route;
  request.vehicle_class = vehicle_class_from_name(details.vehicle_class);
  request.arrival_position = details.arrival_position;
  request.mid_block = details.mid_block;
  request.max_lateral_acceleration = type.max_lateral_acceleration;
  request.comfortable_deceleration = type.comfortable_deceleration;
  request.max_speed =
      details.max_speed > 0.0 ? std::min(details.max_speed, type.max_speed) : type.max_speed;
  request.speed_factor = details.speed_factor;
  request.speed_limits = limits;
  if (type.kinematics == Kinematics::SingleTrack)
    request.cornering = {1.1 * type.wheelbase / std::tan(type.max_steering), details.length,
                         details.width, network.left_hand};
  const auto lane = network.lane_by_name.find(details.lane);
  if (lane != network.lane_by_name.end()) request.start_lane = lane->second;
  request.start_along =
      std::max(0.0, details.lane_position - (details.is_person ? 0.0 : 0.5 * details.length));
  if (!details.is_person) request.stops = route_stops(network, details, route, request);
  auto path = details.is_person ? build_walking_path(network, request, why)
                                : build_driving_path(network, request, why);
  if (!path) return nullptr;
  return std::make_shared<Path>(std::move(*path));
}

std::vector<std::shared_ptr<const Path>> paths_besides(const Model& model,
                                                       const SumoAgentDetails& details,
                                                       AgentTypeId type_id, const Path& path) {
  constexpr double kWorthIt = 3000.0;  // as far as SUMO's departLane="best" looks [m]
  std::vector<std::shared_ptr<const Path>> paths;
  const Lane& chosen = model.road.lane(path.stretches.front().lane);
  const std::vector<LaneId>& lanes = model.road.edge(chosen.edge).lanes;
  const std::vector<LaneOption>& options = path.trip->options.front();
  const double here = options[static_cast<std::size_t>(chosen.index)].drivable;
  std::vector<LaneId> others;
  for (const LaneId id : lanes) {
    const LaneOption& option = options[static_cast<std::size_t>(model.road.lane(id).index)];
    if (id != path.stretches.front().lane && std::isfinite(option.cost) &&
        option.drivable > std::min(here, kWorthIt) - 1.0)
      others.push_back(id);
  }
  auto apart = [&](LaneId id) { return std::abs(model.road.lane(id).index - chosen.index); };
  std::stable_sort(others.begin(), others.end(),
                   [&](LaneId a, LaneId b) { return apart(a) < apart(b); });
  for (const LaneId id : others) {
    SumoAgentDetails moved = details;
    moved.lane = model.road.lane(id).name;
    std::string why;
    if (auto besides = path_of(model, moved, type_id, why, path.trip->request.speed_limits))
      paths.push_back(std::move(besides));
  }
  return paths;
}

void choose_pace(const RoadNetwork& network, SumoAgentDetails& details) {
  constexpr double kSame = 0.01;  // [m/s]
  if (details.vehicle_class != "bicycle") return;
  const auto lane = network.lane_by_name.find(details.lane);
  const double by_road = lane == network.lane_by_name.end()
                             ? 0.0
                             : network.lane(lane->second).speed_limit * details.speed_factor;
  const bool own_pace = details.allowed_speed > 0.0 && details.allowed_speed < by_road - kSame;
  details.max_speed = std::min(
      details.max_speed, own_pace ? details.allowed_speed : kCyclingSpeed * details.speed_factor);
}

void choose_speed_factor(const AgentType& type, std::uint64_t seed, SumoAgentDetails& details) {
  if (type.compliance.speed_factor <= 0.0) return;
  const double factor = draw_speed_factor(type.compliance, seed, fnv1a(details.id));
  // the pace of a bicycle holds its factor already
  if (details.vehicle_class == "bicycle" && details.speed_factor > 0.0)
    details.max_speed *= factor / details.speed_factor;
  details.speed_factor = factor;
}

void choose_mid_block(const AgentType& type, std::uint64_t seed, SumoAgentDetails& details) {
  if (details.is_person)
    details.mid_block = draw_mid_block(type.compliance, seed, fnv1a(details.id));
}

double draw_path_offset(const Model& model, const AgentType& type, std::uint64_t seed, AgentId id) {
  const double kerb_side = model.road.left_hand ? 1.0 : -1.0;
  const double draw = random_uniform(seed, id.value, 1, Draw::Intention);
  if (type.kinematics == Kinematics::Holonomic) return kerb_side * (0.3 + 0.7 * draw);
  if (is_narrow(type.width)) return kerb_side * (0.2 + 0.7 * draw);
  if (type.compliance.place_deviation > 0.0)
    return type.compliance.place_deviation *
           std::clamp(random_normal(seed, id.value, 1, Draw::Intention), -2.0, 2.0);
  return 0.3 * (draw - 0.5);
}

bool departs_at_stop(const SumoAgentDetails& details) {
  constexpr double kAt = 0.1;  // [m]
  if (details.is_person || details.stops.empty()) return false;
  if (stop_state::stopped(details.stop_state)) return true;
  const SumoAgentDetails::Stop& first = details.stops.front();
  return first.lane == details.lane && first.speed <= 0.0 &&
         details.lane_position > first.start - kAt && details.lane_position < first.end + kAt;
}

}  // namespace sumogamma
