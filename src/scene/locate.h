#pragma once

#include "road/road_network.h"
#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// Updates path_along, lane and height of one row from its position: the nearest place on its own
/// path not far from the last one, so that a path that crosses itself is followed in order. Leaves
/// agents without a path alone. Returns the signed distance to the path [m], positive to the left.
double locate_on_path(const RoadNetwork& network, const RoadState& road, Scene& scene,
                      std::size_t row);

/// Goes on by another path, in place of the one that it has, on which the row is `along` [m]; the
/// halts ahead are its first ones.
void take_path(Path path, double along, std::size_t row, RoadState& road, Scene& scene);

/// The planned halt that a row comes to next on its path, or stands at; null behind the last one.
inline const PathStop* next_stop(const Path& path, const Scene& scene, std::size_t row) {
  const auto next = static_cast<std::size_t>(scene.halt[row].next);
  return next < path.stops.size() ? &path.stops[next] : nullptr;
}

}  // namespace sumogamma
