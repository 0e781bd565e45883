#pragma once

#include "base/parallel.h"
#include "model/tick_geometry.h"
#include "traffic/traffic_view.h"

namespace sumogamma {

/// What a tick of the rules reads and writes.
struct TrafficTick {
  const Model& model;
  TickGeometry& geometry;
  Workers& workers;
  double dt;  ///< [s]
  RoadState& road;
  Scene& scene;
  TrafficState& traffic;
  ApproachTable& approaches;
  Perception& perception;
  WaitGraph& waits;
  const TrafficParameters& parameters;
  const TrafficCode& code;
  bool rules = true;  ///< false: paths are ways that somebody means to take, and nothing more
  bool lanes = true;  ///< lanes, places in them and detours are chosen

  TrafficView view() const {
    return {model,      road,  scene,      traffic, geometry.grid, approaches,
            perception, waits, parameters, code,    rules};
  }
};

}  // namespace sumogamma
