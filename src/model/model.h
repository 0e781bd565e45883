#pragma once

#include <cstdint>
#include <vector>

#include "model/kinematic_set.h"
#include "road/conflict_zones.h"
#include "road/road_network.h"
#include "scene/agent_type.h"
#include "scene/scene.h"

namespace sumogamma {

/// The choices where the paper leaves room; each is explained and measured in docs/model.md.
struct ModelOptions {
  bool use_kinematics = true;   ///< ablation: false leaves K out
  bool use_polygons = true;     ///< ablation: false replaces footprints by their circumscribed discs
  bool use_avoidance = true;    ///< ablation: false leaves G out
  bool keep_left = false;       ///< tie-break side: left-hand traffic
};

/// Constant for a run, shared by every thread.
struct Model {
  AgentTypeTable types;
  std::vector<KinematicTable> kinematics;  ///< K by type, in the order of `types`
  RoadNetwork road;                        ///< empty for a standalone scene
  ConflictTable conflicts;                 ///< by connection of `road`
  ModelOptions options;
};

}  // namespace sumogamma
