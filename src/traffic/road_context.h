#pragma once

#include "base/parallel.h"
#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "scene/road_state.h"
#include "traffic/junction/approaches.h"

namespace sumogamma {

/// Fills scene.context of every agent with a path from the frozen scene: where it is (locate), who
/// is ahead, which rules bind at the next links. Two passes: positions and approaches first, then
/// each row by itself, in parallel. dt [s] turns a comfortable acceleration into the most speed
/// allowed at the next tick.
void update_road_contexts(const Model& model, const RoadState& road, const SpatialGrid& grid,
                          double dt, Workers& workers, ApproachTable& approaches, Scene& scene);

}  // namespace sumogamma
