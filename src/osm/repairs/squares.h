#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Replaces pedestrian areas by footways from each of their entrances to their middle: a square is
/// walked across, not round, and netconvert would draw a lane along its outline. Where the middle
/// cannot be seen from all entrances the outline stays, as a plain footway. Road surfaces drawn as
/// areas go.
void replace_squares(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
