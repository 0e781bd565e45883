#pragma once

#include <span>

#include "road/road_network.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// Does a way lead a class from its lane onto that edge?
bool leads_onto(const RoadNetwork& road, ConnectionId way, EdgeId edge, VehicleClassMask mask);

/// Does a route turn back on its own road? On foot SUMO finds no way across a dead end; on wheels
/// it is a U-turn in a cut-off street that nobody would drive.
bool turns_back(const RoadNetwork& road, std::span<const EdgeId> route);

/// Would a driver of such a vehicle take a route? Its turns are not too sharp for the length, and
/// two lane changes or more on one edge have 50 m each, but for edges of up to 10 m between the
/// arms of a junction.
bool suits(const RoadNetwork& road, const AgentType& type, std::span<const EdgeId> route);

}  // namespace sumogamma
