#pragma once

#include <cstdint>
#include <functional>

#include "base/parallel.h"
#include "model/model.h"
#include "simulation/scene_file.h"

namespace sumogamma {

/// Figures of a standalone run; shares are of agents, or of agent-steps where the name says so.
/// Definitions: overlap is of the bare oriented boxes, deeper than 1e-6 m; deep: more than 0.1 m;
/// progress: (distance to the goal at the start - at the end) / (preferred speed * time); stuck:
/// slower than 0.2 m/s for 5 s on end; infeasible: the answer violates some half-plane by more than
/// 0.01 m/s; reversal: a wheeled agent asks for a direction more than 90 degrees off its heading;
/// kinematics violation: it asks for one that its centre can't take within the step even at full
/// lock, or that lies outside K.
struct SceneReport {
  std::size_t agents = 0;
  std::size_t steps = 0;
  double dt = 0;
  double agents_overlapped_share = 0, pairs_per_agent = 0, overlap_share_of_agent_steps = 0,
         deep_agents_share = 0;
  double progress_mean = 0, stuck_share = 0, infeasible_share = 0, reversal_share = 0;
  double kinematics_violation_share = 0, hard_violation_share = 0;
  double neighbours_mean = 0, half_planes_mean = 0;
  double model_cpu_us_per_agent_step = 0, model_wall_us_per_agent_step = 0;
  std::uint64_t state_hash = 0;
};

/// Called with the scene before the first step and after every step.
using SceneObserver = std::function<void(const Scene&)>;

/// Drives the scene for `steps` ticks of `dt` [s]: everybody decides on the frozen scene (Eq. 7),
/// then everybody moves. The state hash and all figures but the times are the same for any number
/// of workers.
SceneReport run_scene(const SceneFile& file, const ModelOptions& options, std::size_t steps,
                      double dt, Workers& workers, const SceneObserver& observer = {});

}  // namespace sumogamma
