#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// New nodes by the two between which they come, in the order from the first to the second.
using AddedNodes = std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::int64_t>>;

/// Puts new nodes into the roads and cycleways that lead over the pairs of nodes, either way.
void insert_nodes(const AddedNodes& added, OsmMap& map);

/// True for a way that bicycles ride on without motors: its bends are rounded, too.
bool is_cycle_way(const MapWay& way);

}  // namespace sumogamma::osm
