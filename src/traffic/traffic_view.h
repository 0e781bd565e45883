#pragma once

#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "scene/road_state.h"
#include "scene/scene.h"
#include "scene/traffic_code.h"
#include "scene/wait_graph.h"
#include "traffic/ego_on_path.h"
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
  const SpatialGrid& grid;          ///< for perception alone: rules read `perception`
  const ApproachTable& approaches;  ///< of this tick once contexts are made: not while lanes are
                                    ///< chosen, and ways found
  const Perception& perception;     ///< likewise of this tick once ways are found
  const WaitGraph& waits;           ///< as contexts were when this part of the tick began
  const TrafficParameters& parameters;
  const TrafficCode& code;
  bool rules = true;  ///< as TrafficTick::rules
};

}  // namespace sumogamma
