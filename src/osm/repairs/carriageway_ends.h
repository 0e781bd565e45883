#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Where the two carriageways of a road meet in one point at or outside the box, splits that point:
/// netconvert would join them into a hairpin that eats its own lanes.
void split_carriageway_ends(OsmMap& map, const GeoBox& box, IssueLog& log);

}  // namespace sumogamma::osm
