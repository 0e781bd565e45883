#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/spatial_grid.h"
#include "prediction/flow_memory.h"

namespace sumogamma {

/// Who counts as a companion.
struct CompanionKernel {
  double distance = 1.5;  ///< scale over which people are near each other [m]
  double speed = 0.2;     ///< scale over which they move alike [m/s]
  double weight = 1;  ///< of a companion at the same place and velocity, against oneself; 0: none
};

/// One agent as its companions see it.
struct Companion {
  Vec2 position, velocity;  ///< [m, m/s]
  bool joins = false;       ///< walks, and has been seen long enough to have a velocity
  std::array<Vec2, FlowMemory::kSteps> path;  ///< displacement at the next steps [m]
};

/// Where a joint motion takes everybody who has companions: the mean of its own path and those of
/// people near by who move alike, weighted by a normal kernel of distance and velocity difference.
/// People who walk together keep together, and two observers of one motion see it better than one.
/// `joint` [like `agents`]: the path itself where nobody is alike. Frozen: reads all, then writes.
/// The first `steps` of the paths are looked at. Cost linear in the agents at a given density.
void join_paths(std::span<const Companion> agents, const CompanionKernel& kernel, SpatialGrid& grid,
                std::vector<std::array<Vec2, FlowMemory::kSteps>>& joint,
                std::size_t steps = FlowMemory::kSteps);

}  // namespace sumogamma
