#pragma once

#include <set>
#include <string>
#include <vector>

#include "road/road_network.h"

namespace sumogamma::osm {

/// Nodes of the map that are to be one junction.
using NodeGroup = std::set<std::string>;

/// The nodes that a junction's name tells it was made of: netconvert's cluster_A_B_#2more of A, B
/// and others.
NodeGroup nodes_of(const std::string& junction);

/// Two junctions that are nearer to each other than each of them is wide swallow the road between
/// them, and netconvert draws what is left of it outside of both: a lane that begins beyond the
/// node where it ends. Its own joining of junctions leaves such pairs where it reduces a large
/// cluster, and leaves others with 0.2 m of road between them: in a small ring whoever waits before
/// the second junction stands across the ways over the first. The nodes of such junctions; of those
/// that netconvert joined, at least the ones in their names.
std::vector<NodeGroup> swallowed_roads(const RoadNetwork& road);

/// A signal and a junction before it with no room for cars between them, where the queue at the
/// signal stands in the way of others: ways over the one and over the other come within 2 m of each
/// other, and neither knows of the other's right of way. The nodes of such junctions, however far
/// apart. Only the finished network tells: where carriageways are moved apart such ways may part.
std::vector<NodeGroup> signals_on_ways(const RoadNetwork& road);

/// Adds a group to others; ones that share a node become one.
void add_group(NodeGroup group, std::vector<NodeGroup>& groups);

}  // namespace sumogamma::osm
