#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Gives two-way main roads without lanes one lane a direction; netconvert guesses two.
void guess_main_road_lanes(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
