#pragma once

#include <cstdint>
#include <vector>

#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// An agent on its own path. One without a path has a width.
struct EgoOnPath {
  double along = 0, offset = 0;  ///< of its middle on the path, and beside it, positive left [m]
  Vec2 tangent = Vec2(1, 0);     ///< unit direction of the path there
  double half_length = 0;        ///< along the path [m]
  double half_width = 0;         ///< across the heading [m]
  double speed = 0;  ///< on foot along the path, >= 0, on wheels along the heading [m/s]
};

EgoOnPath ego_on_path(const RoadState& road, const Scene& scene, std::size_t row);

/// Where everybody is on its path, and who is near whom: by row, once a tick.
struct Perception {
  std::vector<EgoOnPath> ego;
  std::vector<double> reach;  ///< as far as a row's rules look at this tick as a rule [m]
  /// Rows within that reach of a row, on its storey; in the grid's order.
  std::vector<std::vector<std::uint32_t>> near;

  void resize(std::size_t rows) {
    ego.resize(rows);
    reach.resize(rows);
    near.resize(rows);
  }
};

}  // namespace sumogamma
