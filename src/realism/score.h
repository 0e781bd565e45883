#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "model/model.h"
#include "realism/closed_loop.h"
#include "realism/free_score.h"
#include "realism/likelihood.h"
#include "realism/motion_counts.h"
#include "realism/road_loop.h"
#include "scene/behavior_preset.h"

namespace sumogamma {

/// What can be scored.
struct ScoreMethodInfo {
  const char *name, *label;
  bool on_roads = false;  ///< drives on a network alone
};
/// log, stand, cv, cv-fan, gamma, and on a network SUMO's own models: the order of tables.
std::vector<ScoreMethodInfo> score_methods();

/// Does a method move everybody by a model, GAMMA or SUMO's?
bool drives_by_itself(const std::string& method);

/// Throws Error on a name that isn't one of score_methods(), with the one that is nearest to it.
void require_score_method(const std::string& name);

struct ScoreSettings {
  std::vector<std::string> methods;
  std::uint64_t seed = 1;     ///< of the first rollout; the next one's is one more
  std::size_t rollouts = 32;  ///< of methods that draw; the others have one
  std::size_t free_runs = 0;  ///< of methods that drive by themselves (GAMMA, SUMO); 0: none
  ModelOptions model;
  AgentTypeTable behavior = default_agent_types();    ///< how types drive under GAMMA, by name
  BehaviorPreset preset = BehaviorPreset::Compliant;  ///< that it began from, for reports
  const RecordedRoad* road = nullptr;  ///< the network of the place; null: open ground
};

/// One method on one recording.
struct MethodScore {
  std::string name;
  std::size_t rollouts = 1;
  ScoreSums sums;
  std::map<std::string, ScoreSums> by_type;
  std::vector<ScoreSums> by_window;
  double composite_low = 0,
         composite_high = 0;  ///< 95 % by resampling windows; NaN of a single one
  MotionCounts counts;
  EntryCounts entries;
};

/// All methods on one recording.
struct RecordingScore {
  std::string name;
  std::size_t windows = 0, left_out = 0;  ///< windows scored; with too few agents
  std::size_t scored = 0;                 ///< agents, each counted in each of its windows
  MotionCounts log;                       ///< of the recording in the same windows
  std::vector<MethodScore> methods;
  MotionCounts free_log;               ///< of the recording for as long as free runs last
  double free_lateral_deviation = 0;   ///< likewise, see lateral_deviation
  std::vector<FreeScore> free_scores;  ///< of the methods that drive, in order
  std::size_t parts = 0;               ///< of five minutes
  std::vector<double> noise_floor;     ///< Hellinger between them; empty with fewer than two
};

/// Called before each window (or free run) of a method; false ends the scoring.
using ScoreProgress =
    std::function<bool(const std::string& method, std::size_t window, std::size_t windows)>;

/// Scores the methods in order. Cut short, with the methods that were done, where `progress` says
/// so. The same for the same seed, whatever the number of workers.
RecordingScore score_recording(const RecordedScene& scene, const ScoreSettings& settings,
                               Workers& workers, const ScoreProgress& progress);

}  // namespace sumogamma
