#pragma once

#include <cstdint>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "osm/osm_map.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// What a network holds, by stable name: "edges", "lanes", "car_edges", "car_edges_with_sidewalk",
/// "junctions", "signals", "crossings", "walking_areas", "roundabout_junctions", "connections",
/// "car_components", "walk_components", "lanes_under_1_m", "kilometres", and the metres of lane
/// that lie on lanes of other edges (see OverlapLength): "overlapping_lanes_m" for wheels,
/// "overlapping_walkways_m" for walking.
std::map<std::string, double> network_facts(const RoadNetwork& road);

/// Rings of edges that stem from ways tagged as roundabouts and that the network file does not list
/// as roundabouts, in driving order. Needs a network written with --output.original-names.
std::vector<std::vector<std::string>> unmarked_roundabouts(const pugi::xml_node& net,
                                                           const OsmMap& map);

}  // namespace sumogamma::osm
