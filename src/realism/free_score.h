#pragma once

#include <string>
#include <vector>

#include "realism/free_run.h"
#include "realism/motion_counts.h"
#include "realism/road_loop.h"

namespace sumogamma {

/// What some free runs of one method came to, beside the recording.
struct FreeScore {
  std::string name;
  std::size_t runs = 0;
  MotionCounts counts;               ///< of all runs, PET up to 10 s over all of a run
  double travel_rmspe = 0;           ///< see travel_time_error
  std::size_t ways = 0;              ///< movements that it is over
  double left = 0, left_in_log = 0;  ///< agents a run that arrived by its end; in the recording
  double colliding = 0;  ///< share of agents and windows of 8 s in which it overlaps another
  double lateral_deviation = 0;  ///< of centres about the middles of lanes [m]; NaN without a map
};

/// The distributions of a recording, or of a free run: motion in the windows of 8 s that `score`
/// has (none where it is too short), PET over all of it.
MotionCounts count_motion(const RecordedScene& scene);

/// Root mean square, over ways with three who left in the recording, of the relative error of the
/// mean time from when somebody was due to when it left. A way is the first and the last edge of a
/// route; without a map the type of who goes it. Who is on its way at a run's end isn't counted.
double travel_time_error(const RecordedScene& scene, const RecordedRoad* road,
                         const std::vector<FreeRun>& runs, std::size_t& ways);

/// Standard deviation of where vehicles over 1 m/s have their centre beside the middle of the lane
/// under it, of lanes 2.8 to 4.2 m wide, every half second [m]. `who`: agents of the recording.
double lateral_deviation(const RecordedRoad& road, const RecordedScene& driven,
                         const std::vector<std::size_t>& who);

/// Share of encroachments (PET) under 2 s; NaN where there are none.
double share_under_two_seconds(const MotionCounts& counts);

/// The score of some runs; `road` null: open ground.
FreeScore score_free_runs(const RecordedScene& scene, const RecordedRoad* road,
                          const std::string& method, const std::vector<FreeRun>& runs);

}  // namespace sumogamma
