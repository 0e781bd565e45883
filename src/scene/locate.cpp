#include "scene/locate.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

namespace sumogamma {

namespace {

/// The index on `path` of the halt that is next on `old`: those before it are over.
std::int32_t next_stop_on(const Path& path, const Path& old, std::int32_t next) {
  const auto index = static_cast<std::size_t>(next);
  if (index >= old.stops.size()) return static_cast<std::int32_t>(path.stops.size());
  const auto found = std::find_if(path.stops.begin(), path.stops.end(), [&](const PathStop& stop) {
    return stop.plan >= old.stops[index].plan;
  });
  return static_cast<std::int32_t>(found - path.stops.begin());
}

}  // namespace

double locate_on_path(const RoadNetwork& network, const RoadState& road, Scene& scene,
                      std::size_t row) {
  const Path* path = road.path(scene.path[row]);
  if (path == nullptr) return 0.0;
  // one tick moves an agent by a few metres at most; the window forgives a detour. On foot a way
  // may fold back beside itself: whoever is past the fold stays so
  constexpr double kBack = 4.0, kBackOnFoot = 0.5, kAhead = 8.0;
  const double last = scene.path_along[row];
  const double from = last - (path->walking ? kBackOnFoot : kBack);
  PolylinePosition place = path->line.project(scene.position[row], from, last + kAhead);
  // a fast body takes more than the window in a long step: look on where it is at the window's end
  for (double ahead = kAhead; place.along > last + 0.75 * ahead && ahead < 100.0; ahead *= 2.0)
    place = path->line.project(scene.position[row], from, last + 2.0 * ahead);
  scene.path_along[row] = place.along;
  const PathStretch& stretch = path->stretch_at(place.along);
  const double advanced = place.along - stretch.from;
  scene.lane[row] = {stretch.lane, stretch.lane_from + (stretch.reversed ? -advanced : advanced),
                     stretch.reversed ? -place.offset : place.offset};
  scene.height[row] = elevation_at(network.lane(stretch.lane), scene.lane[row].along);
  return place.offset;
}

void take_path(Path path, double along, std::size_t row, RoadState& road, Scene& scene) {
  const Path* old = road.path(scene.path[row]);
  scene.halt[row].next = old ? next_stop_on(path, *old, scene.halt[row].next) : 0;
  road.paths[static_cast<std::size_t>(scene.path[row])] =
      std::make_shared<const Path>(std::move(path));
  scene.path_along[row] = along;
}

}  // namespace sumogamma
