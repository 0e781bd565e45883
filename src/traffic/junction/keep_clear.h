#pragma once

#include "traffic/junction/arbitration.h"
#include "traffic/lateral/course.h"
#include "traffic/longitudinal/leader.h"
#include "traffic/traffic_view.h"

namespace sumogamma {

/// Keep clear: who would have to stop with its body on a junction halts before it, or where it may
/// wait on it, because there is no room behind it, or because it would have to wait before the next
/// one with its rear on this one. For so long at the most: round a block whose roads are full
/// nobody would ever move on. Sorts `ahead`.
LinkDecision keep_clear(const TrafficView& view, const Course& course, const Traveller& traveller,
                        const PathLink& link, DrivingAhead& ahead);

/// The teeth of a zipper where a road is full: who has the right of way there, but has come to
/// stand before the junction, lets one in who came to its line before, some time ago. Not into the
/// short roads of rings, where everybody waits for who is let in.
LinkDecision let_one_in(const TrafficView& view, const Course& course, const Traveller& traveller,
                        const PathLink& link);

/// Does the agent no longer leave others the room to turn? At a signal who stands in its way gets
/// green while it waits, and whoever comes next halts further back: there it lets some cycles pass.
bool takes_turning_room(const TrafficView& view, const Course& course, const PathLink& link);

/// Counts for how long the agent has kept a junction, or the room that others need to turn, clear.
void note_keeping_clear(const TrafficView& view, const Course& course, const RoadContext& context,
                        double dt, TrafficState& traffic);

/// That time counts no more.
void forget_keeping_clear(TrafficState& traffic, std::size_t row);

}  // namespace sumogamma
