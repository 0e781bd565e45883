#pragma once

#include <string>

#include "road/road_network.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// What a replay page draws of the place, as compact JSON: lanes by look and level, junctions, stop
/// lines with the signal links that control them, crossings, buildings, the types' names and sizes.
/// Coordinates in whole decimetres, flat lists.
std::string replay_map_json(const std::string& title, const RoadNetwork& network,
                            const AgentTypeTable& types);

}  // namespace sumogamma
