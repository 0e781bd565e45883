#pragma once

#include <pugixml.hpp>
#include <string>

#include "scene/agent_type.h"

namespace sumogamma {

/// With a fixed number of decimals, as SUMO's files have them.
std::string fixed(double value, int decimals = 2);

/// Appends a type as SUMO's vType.
void append_vehicle_type(pugi::xml_node root, const AgentType& type);

}  // namespace sumogamma
