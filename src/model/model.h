#pragma once

#include <cstdint>
#include <vector>

#include "model/kinematic_set.h"
#include "model/obstacle_index.h"
#include "road/road_network.h"
#include "road/swept_ways.h"
#include "scene/agent_type.h"
#include "scene/scene.h"

namespace sumogamma {

/// Which horizon a pair of agents with different ones reckons with.
enum class PairHorizon : std::uint8_t { Own, Shortest, Longest };

/// The choices where the paper leaves room; each is explained and measured in docs/model.md.
struct ModelOptions {
  bool use_kinematics = true;  ///< ablation: false leaves K out
  bool use_polygons = true;    ///< ablation: false replaces footprints by their circumscribed discs
  bool use_avoidance = true;   ///< ablation: false leaves G out
  bool keep_left = false;      ///< tie-break side: left-hand traffic
  bool constrain_safe_pairs = true;  ///< a half-plane for a pair outside its velocity obstacle, too
  PairHorizon pair_horizon = PairHorizon::Shortest;
  bool pass_as_intended = true;  ///< on which side to pass follows from where both want to go, not
                                 ///< from how they move now
  bool share_responsibility = true;  ///< shares of a pair are made to add up to 1; false: Eq. 5
                                     ///< with the row's own, as it stands
  bool look_aside = true;            ///< people on foot who are held up turn to the passing side
  bool creep_when_held =
      true;  ///< who has to stand creeps round what is in its way where the guard admits it
  bool take_detours = true;       ///< drivers whose way is shut for long take another one
  bool use_guard = true;          ///< ablation: false leaves the stopping guard out
  bool trust_planned = true;      ///< others count on an ego (Control::Planned) to do its share
  double guard_margin = 0.015;    ///< room that the guard keeps between bodies that brake [m]
  double step = 0.05;             ///< length of a tick, which the guard reckons with [s]
  double separation_time = 0.03;  ///< how urgently wheeled bodies that overlap come apart [s];
                                  ///< their own limits take longer
  double margin_time = 0.1;       ///< likewise where only their margins overlap [s]
  double walker_separation_time = 0.5;  ///< likewise where one is on foot [s]
  double front_margin = 0.1, rear_margin = 0.05,
         side_margin = 0.05;    ///< kept around wheeled bodies [m]
  double walker_margin = 0.03;  ///< kept around people on foot [m]
};

/// Constant for a run, shared by every thread.
struct Model {
  AgentTypeTable types;
  std::vector<KinematicTable> kinematics;  ///< K by type, in the order of `types`; of those that
                                           ///< occur
  RoadNetwork road;                        ///< empty for a standalone scene
  ConflictTable conflicts;                 ///< by connection of `road`
  SweptWayTable swept_ways;                ///< likewise
  ObstacleIndex obstacles;                 ///< sides of the solid things of `road`
  ModelOptions options;
};

}  // namespace sumogamma
