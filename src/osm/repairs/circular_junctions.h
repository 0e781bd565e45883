#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Takes junction=circular, which netconvert 1.15 does not know, for a roundabout.
void mark_circular_as_roundabout(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
