#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Rewrites sidewalk:left|right|both and sidewalk=separate, which netconvert 1.15 ignores or takes
/// for "both". Nobody walks through a road tunnel unless its tags say so.
void rewrite_sidewalks(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
