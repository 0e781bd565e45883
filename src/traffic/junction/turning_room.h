#pragma once

#include "traffic/junction/arbitration.h"
#include "traffic/lateral/course.h"

namespace sumogamma {

/// Where the line of a link is drawn [m along the path]: at a signal behind what long bodies sweep
/// of the lane's end, if that isn't far.
double drawn_line(const TrafficView& view, const Traveller& traveller, const PathLink& link);

/// Where a front that waits before a link comes to rest [m along the path]: at its drawn line, or
/// further back where a long body comes that will sweep the lane's end.
double halt_for_long_bodies(const TrafficView& view, const Traveller& traveller,
                            const PathLink& link);

/// Does an agent halt for the room that long bodies need where they turn? A long one lets those
/// past first who stand where it will sweep, and others don't drive into its way (first come, first
/// served; a long one that drives comes before who stands at its edge).
LinkDecision leave_turning_room(const TrafficView& view, const Traveller& traveller,
                                const PathLink& link);

/// The same for somebody whose trip ends at the end of a lane: it takes no link there, but what
/// long bodies sweep of the lane on their ways over the junction behind it is theirs all the same.
LinkDecision leave_room_at_end(const TrafficView& view, const Course& course,
                               const Traveller& traveller);

}  // namespace sumogamma
