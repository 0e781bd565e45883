#pragma once

#include <span>
#include <string>

#include "road/road_network.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// Does a route turn back on its own road? On foot SUMO finds no way across a dead end; on wheels
/// it is a U-turn in a cut-off street that nobody would drive. `edges` by name, all of them known.
bool turns_back(const RoadNetwork& road, std::span<const std::string> edges);

/// Would a driver of such a vehicle take a route? Its turns are not too sharp for the length, and
/// two lane changes or more on one edge have 50 m each, but for edges of up to 10 m between the
/// arms of a junction. `edges` by name, all of them known.
bool suits(const RoadNetwork& road, const AgentType& type, std::span<const std::string> edges);

}  // namespace sumogamma
