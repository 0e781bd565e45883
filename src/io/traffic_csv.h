#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "road/road_network.h"
#include "study/traffic_measures.h"

namespace sumogamma {

/// lanes.csv: a line an interval, lane and type, and one for all types together ("all"). Flow and
/// density of walking areas, which have no length, are empty.
std::string lanes_csv(std::span<const LaneInterval> intervals, const RoadNetwork& network,
                      const AgentTypeTable& types);

/// traffic.csv: a line an interval and type.
std::string traffic_csv(std::span<const TypeInterval> intervals, const AgentTypeTable& types);

/// journeys.csv: a line an agent. `name_of` gives SUMO's id.
std::string journeys_csv(std::span<const AgentJourney> journeys, const AgentTypeTable& types,
                         const std::function<std::string_view(AgentId)>& name_of);

}  // namespace sumogamma
