#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// True for a way that cars may use by its highway tag.
bool is_car_way(const MapWay& way);
/// True for a way that only people on foot or on bicycles use by its highway tag.
bool is_path_way(const MapWay& way);
/// True for a way whose traffic goes one way only, by its tags or by what kind of road it is.
bool is_one_way(const MapWay& way);
/// True for a one-way road against the order of its nodes.
bool is_reversed(const MapWay& way);
/// Place of a road among the classes, 0 for motorways; behind all of them for other ways.
int road_class(const MapWay& way);

/// As a report names it: "way/123".
std::string way_name(const MapWay& way);

/// How many pieces of ways with a highway tag meet in each node; a closed way counts once at the
/// node where it closes.
using Uses = std::map<std::int64_t, int>;
Uses count_node_uses(const OsmMap& map);

}  // namespace sumogamma::osm
