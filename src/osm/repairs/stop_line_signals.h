#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Moves traffic lights that were mapped on stop lines to the junction that they guard, at most
/// `reach` downstream [m]; signalled mid-block crossings stay.
void move_signals_to_junctions(OsmMap& map, double reach, IssueLog& log);

}  // namespace sumogamma::osm
