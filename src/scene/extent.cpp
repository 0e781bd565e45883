#include "scene/extent.h"

#include <algorithm>

#include "road/conflict_zones.h"

namespace sumogamma {

double half_extent(const Scene& scene, std::size_t row, const Vec2& direction) {
  const Vec2 local = to_body(direction, direction_of(scene.heading[row]));
  double extent = 0.0;
  for (const Vec2& vertex : scene.footprint[row].outline())
    extent = std::max(extent, vertex.dot(local));
  return extent;
}

OrientedBox box_of(const Scene& scene, std::size_t row) {
  const Vec2 forward = direction_of(scene.heading[row]);
  return {scene.position[row], forward,
          Vec2(half_extent(scene, row, forward), half_extent(scene, row, left_of(forward)))};
}

bool is_wide(const Scene& scene, std::size_t row) {
  const Vec2 across = left_of(direction_of(scene.heading[row]));
  return 2.0 * half_extent(scene, row, across) > kWideBody;
}

}  // namespace sumogamma
