#pragma once

#include "base/parallel.h"
#include "model/surroundings.h"

namespace sumogamma {

/// Buffers of choose_lanes, reused from tick to tick.
struct LaneChoiceWork {
  std::vector<Surroundings> around;     ///< by worker
  std::vector<LaneId> wanted;           ///< by row
  std::vector<std::uint8_t> postponed;  ///< by row: a planned change finds no gap yet
};

/// Lanes and places within them, before anybody's road context is put together: who drives on a
/// road with several lanes moves over where that is faster, safe for whoever comes from behind (the
/// criterion of MOBIL, Kesting et al. 2007) and leads on along the trip; its path is made again.
/// Who meets somebody slow and narrow passes within the lane where there is room, and narrow
/// vehicles pass between queues. Each agent looks again a few times a second. Sets
/// scene.lateral_aim of every row with a driving path.
void choose_lanes(const Model& model, const SpatialGrid& grid, double dt, Workers& workers,
                  RoadState& road, Scene& scene, LaneChoiceWork& work);

}  // namespace sumogamma
