#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Makes paths of roads that motors may not enter, for those who may; where some motors may they
/// stay roads, whose type shuts out the others (road_types.h).
void close_to_motors(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
