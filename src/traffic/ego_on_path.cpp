#include "traffic/ego_on_path.h"

#include <algorithm>

#include "scene/extent.h"

namespace sumogamma {

EgoOnPath ego_on_path(const RoadState& road, const Scene& scene, std::size_t row) {
  EgoOnPath ego;
  ego.half_width = half_extent(scene, row, left_of(direction_of(scene.heading[row])));
  const Path* path = road.path(scene.path[row]);
  if (path == nullptr) return ego;
  ego.along = scene.path_along[row];
  ego.tangent = path->line.direction_at(ego.along);
  ego.offset = cross(ego.tangent, scene.position[row] - path->line.point_at(ego.along));
  ego.half_length = half_extent(scene, row, ego.tangent);
  ego.speed =
      path->walking ? std::max(0.0, scene.velocity[row].dot(ego.tangent)) : scene.speed[row];
  return ego;
}

}  // namespace sumogamma
