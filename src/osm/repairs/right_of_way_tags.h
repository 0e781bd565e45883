#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "osm/netconvert.h"
#include "osm/network_file.h"
#include "osm/osm_map.h"
#include "osm/signs.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// SUMO's junction types for nodes with so many stop signs: "allway_stop" where every road for cars
/// has one, else "priority_stop". Only junctions that kept their node's id and are ruled by
/// priority: joined or signalled ones are left.
std::map<std::string, std::string> stop_types(const RoadNetwork& road, const SignsByJunction& stop);

/// Junctions without signals that stem from nodes tagged as mini-roundabouts.
std::vector<std::string> mini_roundabouts(const RoadNetwork& road, const OsmMap& map);

/// Who comes by a road with a give-way sign waits for those whose ways it crosses that come by
/// roads without one. Not at signals. Needs a network written with --output.original-names.
std::vector<Prohibition> give_way_rules(const NetworkFile& network,
                                        const SignsByJunction& give_way);

}  // namespace sumogamma::osm
