#include "traffic/recovery/lost_way.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "road/route_search.h"
#include "scene/extent.h"
#include "scene/locate.h"
#include "traffic/lateral/lane_choice.h"

namespace sumogamma {

namespace {

/// The nearest place on the row's own path, up to some way ahead, that it stands on, headed as the
/// path leads.
std::optional<double> place_ahead(const TrafficView& view, const Path& path, std::size_t row) {
  const TrafficParameters& parameters = view.parameters;
  const Scene& scene = view.scene;
  const Vec2 forward = direction_of(scene.heading[row]);
  const double from = scene.path_along[row],
               to = std::min(from + parameters.queue_outlook, path.arrival);
  std::optional<double> best;
  double nearest = parameters.near;
  for (double along = from; along <= to; along += parameters.path_step) {
    const double distance = (path.line.point_at(along) - scene.position[row]).norm();
    if (distance >= nearest || path.line.direction_at(along).dot(forward) < 0.5) continue;
    nearest = distance;
    best = along;
  }
  return best;
}

/// A lane that somebody may get onto.
struct Candidate {
  LaneId lane;
  double distance, along;  ///< of its middle, and there [m]
};

/// Lanes near the row that lead as it heads, nearest first.
std::vector<Candidate> lanes_near(const TrafficView& view, VehicleClassMask vehicle_class,
                                  std::size_t row) {
  const RoadNetwork& network = view.model.road;
  const TrafficParameters& parameters = view.parameters;
  const Scene& scene = view.scene;
  const Vec2 forward = direction_of(scene.heading[row]);
  std::vector<Candidate> found;
  for (std::size_t i = 0; i < network.lanes.size(); ++i) {
    const Lane& lane = network.lanes[i];
    if (lane.kind != LaneKind::Normal || (lane.allowed & vehicle_class) == 0) continue;
    const PolylinePosition place = lane.centerline.project(scene.position[row]);
    if (place.distance > parameters.nearby ||
        place.along > lane.centerline.length() - parameters.soon_way ||
        lane.centerline.direction_at(place.along).dot(forward) < 0.5)
      continue;
    found.push_back({static_cast<LaneId>(i), place.distance, place.along});
  }
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.lane < b.lane;
  });
  return found;
}

/// A new path to the row's destination from a lane near it; `along` is its place on that.
std::optional<Path> way_from_here(const TrafficView& view, const Path& path, std::size_t row,
                                  double& along) {
  const RoadNetwork& network = view.model.road;
  const Trip& trip = *path.trip;
  const std::vector<double> times = free_travel_times(network);
  for (const Candidate& candidate : lanes_near(view, trip.request.vehicle_class, row)) {
    const EdgeId edge = network.lane(candidate.lane).edge;
    const std::vector<EdgeId> route =
        edge == trip.route.back() ? std::vector<EdgeId>{edge}
                                  : fastest_route(network, candidate.lane, trip.route.back(),
                                                  trip.request.vehicle_class, times);
    if (route.empty()) continue;
    PathRequest request = trip.request;
    request.route = route;
    request.start_lane = candidate.lane;
    request.start_along = std::max(candidate.along - view.parameters.nearby, 0.0);
    std::string why;
    auto found = build_driving_path(network, request, why);
    if (!found || found->arrival < candidate.along - request.start_along) continue;
    along = candidate.along - request.start_along;
    return found;
  }
  return std::nullopt;
}

}  // namespace

void note_progress(const TrafficParameters& parameters, double before, double dt,
                   const Scene& scene, TrafficState& traffic, std::size_t row) {
  const double got_on = std::max(scene.path_along[row] - before, 0.0);
  const double driven = scene.velocity[row].norm() * dt;
  traffic.strayed[row] = std::max(traffic.strayed[row] + driven - parameters.slack * got_on, 0.0);
}

void find_ways_back(const TrafficTick& tick) {
  const TrafficView view = tick.view();
  const RoadNetwork& network = tick.model.road;
  RoadState& road = tick.road;
  Scene& scene = tick.scene;
  TrafficState& traffic = tick.traffic;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (traffic.strayed[row] < tick.parameters.soon_way) continue;
    traffic.strayed[row] = 0.0;
    const Path* path = road.path(scene.path[row]);
    if (path == nullptr || !path->trip || scene.control[row] != Control::Gamma) continue;
    if (const auto place = place_ahead(view, *path, row)) {
      scene.path_along[row] = *place;
      continue;
    }
    // no other way is known to lead past its halts
    const double along_now = scene.path_along[row];
    const auto& stops = path->stops;
    if (std::any_of(stops.begin(), stops.end(),
                    [&](const PathStop& stop) { return stop.along > along_now; }))
      continue;
    double along = 0.0;
    auto found = way_from_here(view, *path, row, along);
    if (!found) continue;
    change_path(std::move(*found), along, row, road, scene, traffic);
    forget_lane_change(traffic, row);
    locate_on_path(network, road, scene, row);
  }
}

}  // namespace sumogamma
