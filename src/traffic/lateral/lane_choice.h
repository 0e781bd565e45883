#pragma once

#include <limits>

#include "traffic/lateral/lane_queues.h"
#include "traffic/perception.h"
#include "traffic/traffic_tick.h"

namespace sumogamma {

/// What an agent makes of the lanes around it.
struct LaneIntent {
  bool fresh = false;         ///< it has looked at this tick
  bool postpone = false;      ///< a planned change is due and finds no gap yet
  bool abort = false;         ///< a change that was begun does not get on
  LaneId wanted = kNoLane;    ///< lane to go over to now: where it would be better off, or has to
  LaneId entered = kNoLane;   ///< free lane beside the one that its link leads to
  LaneId merge_to = kNoLane;  ///< see TrafficState
  double gate = std::numeric_limits<double>::infinity();  ///< see TrafficState
};

/// Buffers of choose_lanes, reused from tick to tick.
struct LaneChoiceWork {
  std::vector<Surroundings> around;  ///< by worker
  std::vector<Surroundings> far;     ///< by worker, far ahead
  std::vector<LaneIntent> intents;   ///< by row
  LaneQueues queues;
};

/// How far a row looks around at this tick [m], 0 where it doesn't. dt [s].
double outlook(const TrafficView& view, std::size_t row, double dt);

/// Lanes and places within them, before anybody's road context is put together: who drives on a
/// road with several lanes moves over where that is faster, safe for whoever comes from behind (the
/// criterion of MOBIL, Kesting et al. 2007) and leads on along the trip; its path is made again.
/// Who meets somebody slow and narrow passes within the lane where there is room, and narrow
/// vehicles pass between queues. Each agent looks again a few times a second. Sets
/// TrafficState::lateral_aim of every row with a path.
void choose_lanes(const TrafficTick& tick, LaneChoiceWork& work);

/// A row no longer has to change lanes, as its new path leads on from where it is.
void forget_lane_change(TrafficState& traffic, std::size_t row);

}  // namespace sumogamma
