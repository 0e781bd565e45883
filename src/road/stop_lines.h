#pragma once

#include "road/road_network.h"

namespace sumogamma {

/// Sets Connection::setback of every link that vehicles wait before: a lane of SUMO ends where the
/// junction's outline is, so that whoever waits there with a body may stand in the way of those who
/// turn into the road beside it. The front halts so much earlier that they get past; 0 where that
/// is no matter, or where 10 m do not help.
void set_back_stop_lines(RoadNetwork& network);

}  // namespace sumogamma
