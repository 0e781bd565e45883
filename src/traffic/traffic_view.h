#pragma once

#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "scene/road_state.h"
#include "scene/scene.h"
#include "scene/traffic_code.h"
#include "traffic/junction/approaches.h"
#include "traffic/parameters.h"
#include "traffic/traffic_state.h"

namespace sumogamma {

/// What every rule of one tick reads: the frozen scene, what is known of its roads, and what the
/// rules remember.
struct TrafficView {
  const Model& model;
  const RoadState& road;
  const Scene& scene;
  const TrafficState& traffic;
  const SpatialGrid& grid;
  const ApproachTable& approaches;  ///< of this tick once contexts are made: not while lanes are
                                    ///< chosen, and ways found
  const TrafficParameters& parameters;
  const TrafficCode& code;
};

}  // namespace sumogamma
