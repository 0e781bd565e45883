#pragma once

#include <vector>

#include "osm/repairs/swallowed_roads.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// Of the groups of nodes that netconvert made one junction each, those with more links than SUMO
/// rules: it then leaves nobody the right of way (type "unregulated"). netconvert joins what lies
/// close to each other however long the chain gets: a street with a driveway each few metres
/// becomes one junction, over which everybody may turn from each driveway into each other.
std::vector<NodeGroup> unruled_junctions(const RoadNetwork& road,
                                         const std::vector<NodeGroup>& joined);

}  // namespace sumogamma::osm
