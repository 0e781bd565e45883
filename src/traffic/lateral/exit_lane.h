#pragma once

#include "traffic/lateral/lane_queues.h"
#include "traffic/perception.h"

namespace sumogamma {

/// The lane beside the one that the junction ahead leads to, on which a vehicle comes out of it:
/// where its own is full of a queue, the other is not and leads on as well, and all who might come
/// into that have red. kNoLane where it keeps its own, for long bodies always.
LaneId free_entry(const TrafficView& view, const LaneQueues& queues, const Path& path,
                  const Surroundings& around);

}  // namespace sumogamma
