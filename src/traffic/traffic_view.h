#pragma once

#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "scene/road_state.h"
#include "scene/scene.h"
#include "traffic/junction/approaches.h"

namespace sumogamma {

/// The frozen scene and what is known of its roads, for the rules of one tick.
struct RoadView {
  const Model& model;
  const RoadState& road;
  const Scene& scene;
  const SpatialGrid& grid;
  const ApproachTable& approaches;
};

}  // namespace sumogamma
