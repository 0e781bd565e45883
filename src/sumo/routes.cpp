// Routes are SUMO's: rerouters and rerouting devices change them, and a vehicle of ours follows;
// where ours finds another way by itself, SUMO is told (docs/coupling.md).

#include <spdlog/spdlog.h>

#include <algorithm>

#include "base/units.h"
#include "road/replan.h"
#include "scene/locate.h"
#include "sumo/sumo_agents.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

bool SumoWorld::same_way(const Path& path, double along, const SumoAgentDetails& details) const {
  if (!path.trip) return false;
  const int index = path.stretch_at(along).route_index;
  const std::vector<EdgeId>& ours = path.trip->route;
  const auto sumos = static_cast<std::size_t>(details.route_index);
  if (index < 0 || sumos > details.route.size() ||
      ours.size() - static_cast<std::size_t>(index) != details.route.size() - sumos)
    return false;
  return std::equal(
      ours.begin() + index, ours.end(), details.route.begin() + details.route_index,
      [&](EdgeId edge, const std::string& name) { return model_.road.edge(edge).name == name; });
}

/// A new path by the route, the lane and the place that SUMO has for a vehicle of ours now.
bool SumoWorld::follow_sumos_route(SumoAgentDetails& details, AgentId id, std::size_t row,
                                   Scene& scene, RoadState& road) {
  auto path = way_of(details, scene.type[row]);
  if (!path) return false;
  KnownAgent& known = known_[id.value];
  known.stops = std::move(details.stops);
  known.route = std::move(details.route);
  known.trip = path->trip;
  scene.path_along[row] = path->line.project(scene.position[row]).along;
  scene.halt[row].next = 0;
  road.paths[id.value] = std::move(path);
  return true;
}

/// Vehicles that have been shown to the rerouters of their edge take the routes that these gave
/// them.
void SumoWorld::follow_rerouters(Scene& scene, RoadState& road) {
  if (shown_.empty()) return;
  std::vector<std::string> ids;
  for (const AgentId id : shown_) ids.push_back(known_[id.value].sumo_id);
  auto all = backend_.details(ids, {});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t row = find_row(scene, shown_[i]);
    if (row == scene.size() || all[i].type_id.empty() || scene.control[row] != Control::Gamma)
      continue;
    if (same_way(*road.path(scene.path[row]), scene.path_along[row], all[i])) continue;
    follow_sumos_route(all[i], shown_[i], row, scene, road);
  }
  shown_.clear();
}

/// Is a vehicle of ours to be shown to the rerouters of the edge that it has just entered?
bool SumoWorld::enters_rerouter(const Scene& scene, std::size_t row) {
  if (at_rerouter_.empty() || scene.lane[row].lane == kNoLane) return false;
  const Lane& lane = model_.road.lane(scene.lane[row].lane);
  if (lane.kind != LaneKind::Normal) return false;
  KnownAgent& known = known_[scene.id[row].value];
  if (known.edge == lane.edge) return false;
  known.edge = lane.edge;
  return at_rerouter_[index_of(lane.edge)];
}

/// SUMO has the route that a vehicle of ours drives, also where the driver has chosen another.
void SumoWorld::tell_routes(const Scene& scene, const RoadState& road) {
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::Gamma) continue;
    KnownAgent& known = known_[scene.id[row].value];
    const Path* path = road.path(scene.path[row]);
    if (path == nullptr || !path->trip || path->trip == known.trip) continue;
    const bool first = known.trip == nullptr;
    known.trip = path->trip;
    if (first || known.route.empty()) continue;
    std::vector<std::string> ours;
    for (const EdgeId edge : path->trip->route) ours.push_back(model_.road.edge(edge).name);
    const auto begun = std::find(known.route.begin(), known.route.end(), ours.front());
    if (begun == known.route.end() ||
        std::equal(begun, known.route.end(), ours.begin(), ours.end()))
      continue;
    ours.insert(ours.begin(), known.route.begin(), begun);
    backend_.set_route(known.sumo_id, ours);
    known.route = std::move(ours);
  }
}

/// Rerouting devices look at the times that the edges take now, as in SUMO, every period.
void SumoWorld::look_for_faster_routes(Scene& scene, RoadState& road) {
  constexpr double kInterval = 1.0;  // SUMO's adaptation interval [s]
  if (!has_rerouting_ || time_ < next_look_) return;
  next_look_ = time_ + kInterval;
  edge_speeds_.add(model_.road, scene);
  bool told = false;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::Gamma) continue;
    KnownAgent& known = known_[scene.id[row].value];
    if (known.reroute_period <= 0.0 || time_ < known.next_reroute ||
        known.service != StopService::None)
      continue;
    const Path& path = *road.path(scene.path[row]);
    const PathStretch& here = path.stretch_at(scene.path_along[row]);
    const Lane& lane = model_.road.lane(here.lane);
    // on junctions and amid lane changes a little later
    if (lane.kind != LaneKind::Normal || here.changing || !path.trip) continue;
    known.next_reroute = time_ + known.reroute_period;
    if (!std::exchange(told, true))
      for (const auto& [edge, seconds] : edge_speeds_.take_changes(model_.road))
        backend_.set_travel_time(model_.road.edge(edge).name, seconds);
    const std::vector<std::string> found =
        backend_.find_route(model_.road.edge(lane.edge).name,
                            model_.road.edge(path.trip->route.back()).name, known.type_id);
    std::vector<EdgeId> route;
    for (const std::string& name : found) {
      const auto edge = model_.road.edge_by_name.find(name);
      if (edge != model_.road.edge_by_name.end()) route.push_back(edge->second);
    }
    const auto& ours = path.trip->route;
    if (route.size() != found.size() || route.empty() ||
        std::equal(route.begin(), route.end(), ours.begin() + here.route_index, ours.end()))
      continue;
    constexpr double kBack = 30.0;  // [m]
    if (auto other =
            take_route({model_.road, path, scene.path_along[row], kBack}, std::move(route)))
      take_path(std::move(other->path), other->along, row, road, scene);
  }
}

/// Paths by the limits that hold now.
void SumoWorld::follow_limits(const Scene& scene, RoadState& road) {
  const std::vector<bool> changed = read_limits(model_.road, time_, backend_, limits_);
  if (changed.empty()) return;
  const auto renew = [&](std::shared_ptr<const Path>& path) {
    if (path && uses_lanes(*path, changed))
      path = std::make_shared<const Path>(with_speed_limits(*path, *limits_.limits));
  };
  for (const PathId id : scene.path)
    if (id != kNoPath) renew(road.paths[static_cast<std::size_t>(id)]);
  for (PendingAgent& pending : pending_) renew(pending.entry.path);
}

}  // namespace sumogamma
