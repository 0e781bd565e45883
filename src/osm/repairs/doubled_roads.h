#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Drops what is drawn twice: where several ways lead over the same two nodes one after the other,
/// only the best of them keeps that piece, a two-way road before a one-way one, a higher class
/// before a lower one, the older id before the newer. One-way roads in opposite directions both
/// stay. A path on a road that people may walk along goes, too. What is left of a way keeps its
/// tags; its first piece keeps its id. Expects tags as normalise_tags() leaves them.
///
/// netconvert lays the lanes of such ways into each other, and names for a lane an opposite one
/// whose own opposite is a third: SUMO 1.15 crashes when somebody overtakes there.
void drop_doubled_roads(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
