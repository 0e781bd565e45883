#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Turns the order of turn:lanes round, for maps where traffic keeps left: OSM counts lanes from
/// the left, netconvert 1.15 reads these ones from the kerb in any case (SUMO issue 13549), and
/// those who turn left would cross the way of those who turn right.
void reverse_turn_lanes(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
