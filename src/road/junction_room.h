#pragma once

#include "base/parallel.h"
#include "road/road_network.h"

namespace sumogamma {

/// Sets Lane::beside_left and Lane::beside_right of every lane on a junction that vehicles drive: a
/// junction has no kerb beside each of its lanes, and long bodies swing out, but not on to where
/// people walk. None where only people on foot and bicycles go: who rode round somebody there came
/// out on the wrong side of a queue.
void set_junction_rooms(RoadNetwork& network, Workers& workers);

}  // namespace sumogamma
