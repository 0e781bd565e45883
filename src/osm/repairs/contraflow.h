#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Writes which way bicycles and buses go in one-way roads as netconvert 1.15 reads it: it builds a
/// lane against the traffic for cycleway:left alone (cycleway:right where the road runs against
/// its nodes) and ignores oneway:bicycle=no and cycleway=opposite. A lane at the side of the
/// oncoming traffic that isn't told to lead against it leads along with the traffic. Where no lane
/// is marked for bicycles that may ride against the traffic they get one: SUMO has no other way.
void rewrite_contraflow(OsmMap& map, bool left_hand, IssueLog& log);

}  // namespace sumogamma::osm
