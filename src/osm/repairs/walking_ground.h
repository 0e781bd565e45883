#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// Walking areas without the ground that vehicles need where they turn: outlines [m] by lane.
/// netconvert draws an area from the corners of the lanes that meet there, sharper than anybody
/// turns; a kerb follows the turn. What motorcycles, cars, vans, trucks and buses drive beside the
/// lanes of a junction, corners rounded for each, is taken off: 1.2 m to either side of the middle
/// of a car or van, 0.6 m of others, since the rear of a long body cuts corners in any case. The
/// straight ways of people between the lanes on foot stay, as wide as those. Areas that would
/// fall apart, so that somebody's lane ends off what is left, stay as they are.
std::map<std::string, std::vector<Vec2>> walking_areas_off_the_road(const RoadNetwork& road);

/// Writes outlines of walking areas into the elements of the network `road`, with heights where it
/// has them.
void set_walking_areas(pugi::xml_node net, const RoadNetwork& road,
                       const std::map<std::string, std::vector<Vec2>>& outlines);

}  // namespace sumogamma::osm
