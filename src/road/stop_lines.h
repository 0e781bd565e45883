#pragma once

#include "base/parallel.h"
#include "road/path.h"
#include "road/road_network.h"

namespace sumogamma {

/// Sets Connection::setback of every link that vehicles wait before: a lane of SUMO ends where the
/// junction's outline is, so that whoever waits there with a body may stand in the way of those who
/// turn into the road beside it. The front halts so much earlier that they get past; 0 where that
/// is no matter, or where neither 30 m nor half of the lane help.
void set_back_stop_lines(RoadNetwork& network, Workers& workers);

/// Moves PathLink::halt of every crossing on a walk back to where nobody drives: SUMO's walking
/// areas, and so the ends of its crossings, may lie on the ways that vehicles take. Up to 10 m, and
/// not over the crossing before; where that does not help the halt stays as it is.
void halt_off_the_road(const RoadNetwork& network, Path& path);

}  // namespace sumogamma
