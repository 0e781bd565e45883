#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Leaves out what nobody travels: highway values that are no way (planned, platform, ...), and
/// private, indoor and underground-walk ways. A road of unknown class is taken for unclassified.
void drop_untravelled(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
