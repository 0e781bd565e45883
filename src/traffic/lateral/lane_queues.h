#pragma once

#include <vector>

#include "traffic/traffic_view.h"

namespace sumogamma {

/// Length of the queue on each lane [m], by LaneId: of the bodies that stand or creep on it, with
/// the gaps between them. SUMO's LC2013 calls it the occupation.
using LaneQueues = std::vector<double>;

/// From everybody with a driving path.
void measure_queues(const TrafficView& view, LaneQueues& queues);

/// Length of the queues on the lanes that a path leads along within `reach` from `along` on [m].
double queue_ahead(const LaneQueues& queues, const Path& path, double along, double reach);

/// Has a lane no room for a body of so many metres behind its queue?
bool is_full(const LaneQueues& queues, const Lane& lane, LaneId id, double length);

}  // namespace sumogamma
