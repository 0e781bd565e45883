#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// netconvert 1.15 loses a crossing half way along a road unless a footway shares its node: gives
/// such nodes a short footway to either side, so that a crossing is built between the sidewalks.
/// Nodes within 15 m of a junction are left to the crossings that it gets anyway.
void add_footways_at_crossings(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
