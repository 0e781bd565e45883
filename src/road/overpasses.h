#pragma once

#include "road/road_network.h"

namespace sumogamma {

/// Fills RoadNetwork::overpasses and Lane::has_overpass. Ways of OpenStreetMap that cross have a
/// node in common where they meet; without one, one of them is a bridge or a tunnel, whether the
/// map's layers and heights say so or not (a ramp that winds over itself is one way, of one layer).
/// So: roads for motor vehicles whose centerlines cross, at 30 degrees or more and 12 m or more
/// from the ends of both, or anywhere where their layers differ and no junction joins them; of one
/// and itself, or the two directions of one road, where 40 m or more lie between. And where a link
/// of a junction crosses a road from elsewhere that is 1.5 m higher or lower there.
void find_overpasses(RoadNetwork& network);

}  // namespace sumogamma
