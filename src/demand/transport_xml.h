#pragma once

#include <pugixml.hpp>
#include <span>

#include "demand/riders.h"

namespace sumogamma {

/// Buses with their routes and stops and riders with their walks and ride, as SUMO's <vehicle> and
/// <person>, sorted by departure. Needs the types "bus" and "pedestrian" and the stops.
void append_transport(pugi::xml_node root, const RoadNetwork& road, const DemandRequest& request,
                      std::span<const BusRun> runs, std::span<const Rider> riders);

}  // namespace sumogamma
