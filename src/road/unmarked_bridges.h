#pragma once

#include "road/road_network.h"

namespace sumogamma {

/// Fills RoadNetwork::unmarked_bridges. Ways of OpenStreetMap that cross have a node in common
/// where they meet; without one, one of them is a bridge or a tunnel, also where neither says so (a
/// ramp that winds over itself is one way, of one layer). So: roads for cars whose centerlines
/// cross, at 30 degrees or more and 12 m or more from the ends of both, on the same layer and
/// heights that don't tell them apart.
void find_unmarked_bridges(RoadNetwork& network);

}  // namespace sumogamma
