#pragma once

#include <limits>

#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "model/road_state.h"

namespace sumogamma {

/// What is next in the way on an agent's path.
struct Leader {
  double gap = std::numeric_limits<double>::infinity();  ///< free metres between own front and it,
                                                         ///< along the path
  double speed = 0;                                      ///< of it along the path there, >= 0 [m/s]
  double along = 0;                                      ///< of its rear on the path [m]
  std::int64_t id = -1;                                  ///< -1: free road
};

/// Nearest agent ahead whose footprint reaches into the corridor that the row's body will sweep
/// along its path, whoever drives it. Vehicles that don't move the same way don't count (right of
/// way and avoidance see to them), people on foot when near. `reach` is how far to look [m].
Leader find_leader(const Model& model, const RoadState& road, const Scene& scene,
                   const SpatialGrid& grid, std::size_t row, double reach);

}  // namespace sumogamma
