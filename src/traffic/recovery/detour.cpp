#include "traffic/recovery/detour.h"

#include <algorithm>

#include "road/route_search.h"
#include "scene/extent.h"
#include "traffic/junction/keep_clear.h"
#include "traffic/lateral/lane_choice.h"
#include "traffic/patience.h"
#include "traffic/perception.h"

namespace sumogamma {

namespace {

/// Is the way of a driver shut, and can it still take another one? The link before which it stands,
/// null where not.
const PathLink* shut_link(const TrafficView& view, const Path& path, std::size_t row) {
  const LimitReason reason = view.scene.context[row].reason;
  const bool waits_for_gap = reason == LimitReason::Merge && stood(view, row) >= Patience::Stuck;
  if (!path.trip || (!waits_for_gap && kept_clear(view, row) < Patience::Stuck)) return nullptr;
  if (2.0 * half_extent(view.scene, row, direction_of(view.scene.heading[row])) > kLongBody)
    return nullptr;
  const double along = view.scene.path_along[row];
  const PathStretch& here = path.stretch_at(along);
  if (here.changing || view.model.road.lane(here.lane).kind != LaneKind::Normal) return nullptr;
  const double front = along + half_extent(view.scene, row, path.line.direction_at(along));
  const auto link = path.link_after(along);
  return link != path.links.end() && front < link->stop_line + 0.3 ? &*link : nullptr;
}

/// Time that each edge takes as the roads are now [s], by EdgeId.
std::vector<double> travel_times(const TrafficView& view) {
  const RoadNetwork& network = view.model.road;
  const Scene& scene = view.scene;
  std::vector<double> times = free_travel_times(network);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.lane[row].lane == kNoLane || stood(view, row) < Patience::Waiting) continue;
    const Lane& lane = network.lane(scene.lane[row].lane);
    if (lane.kind != LaneKind::Normal) continue;
    times[index_of(lane.edge)] += view.parameters.queued_vehicle_time /
                                  static_cast<double>(network.edge(lane.edge).lanes.size());
  }
  return times;
}

/// Is there room at the begin of a path's next road for its agent?
bool has_room(const TrafficView& view, const Replanned& way, std::size_t row) {
  const Scene& scene = view.scene;
  const auto link = way.path.link_after(way.along);
  if (link == way.path.links.end()) return true;
  const LaneId target = view.model.road.connection(link->connection).to;
  const double own = 2.0 * half_extent(scene, row, direction_of(scene.heading[row]));
  for (std::size_t other = 0; other < scene.size(); ++other) {
    if (scene.lane[other].lane != target || scene.speed[other] > 2.0) continue;
    const double half = half_extent(scene, other, direction_of(scene.heading[other]));
    if (scene.lane[other].along - half < own + view.parameters.near_line) return false;
  }
  return true;
}

}  // namespace

std::uint64_t take_detours(const TrafficTick& tick) {
  const Model& model = tick.model;
  RoadState& road = tick.road;
  Scene& scene = tick.scene;
  TrafficState& traffic = tick.traffic;
  const TrafficView view = tick.view();
  std::uint64_t taken = 0;
  std::vector<double> times;
  auto go_on = [&](Replanned way, std::size_t row) {
    go_on_by(tick, std::move(way), row);
    forget_lane_change(traffic, row);
  };
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (!is_its_turn(view, row, tick.dt)) continue;
    const Path* path = road.path(scene.path[row]);
    if (path == nullptr || scene.control[row] != Control::Gamma) continue;
    const PathLink* shut = shut_link(view, *path, row);
    if (shut == nullptr) continue;
    const Replan from = replan(tick, row);
    if (scene.context[row].reason == LimitReason::Merge) {
      // the lane may lead where it has to go as well, if not as easily
      if (auto kept = keep_lane(from, tick.parameters.not_as_easily)) {
        go_on(std::move(*kept), row);
        continue;
      }
    }
    if (times.empty()) times = travel_times(view);
    const PathStretch& here = path->stretch_at(from.along);
    // by any way but the one that is shut
    const EdgeId full = model.road.lane(model.road.connection(shut->connection).to).edge;
    const double passable = times[index_of(full)];
    times[index_of(full)] = 1e6;
    auto route = fastest_route(model.road, here.lane, path->trip->route.back(),
                               path->trip->request.vehicle_class, times);
    times[index_of(full)] = passable;
    if (route.size() < 2 || route[1] == full) continue;
    auto other = take_route(from, std::move(route));
    if (!other || !has_room(view, *other, row)) continue;
    go_on(std::move(*other), row);
    forget_keeping_clear(traffic, row);
    ++taken;
  }
  return taken;
}

}  // namespace sumogamma
