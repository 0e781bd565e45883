#pragma once

#include <vector>

#include "osm/netconvert.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// Turns over a junction that lead backwards: their way begins more than 100 degrees off the way of
/// the lane that they leave and runs back more than a metre behind its end. netconvert draws them
/// mostly where it joined junctions: the lane ends beyond the road that it turns into. A body would
/// have to turn on the spot. Turnarounds don't count.
std::vector<ConnectionId> backward_turns(const RoadNetwork& road);

/// Those of some turns that nobody needs: whoever may make them gets from the one road to the other
/// without any of those that are told, on whatever way there is, and their lane leads on elsewhere.
std::vector<ConnectionId> dispensable_turns(const RoadNetwork& road,
                                            const std::vector<ConnectionId>& turns);

/// As netconvert wants them told.
Turn named_turn(const RoadNetwork& road, ConnectionId turn);

}  // namespace sumogamma::osm
