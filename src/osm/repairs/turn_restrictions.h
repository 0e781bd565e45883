#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Drops turn restrictions that lost a member or no longer join at their via node.
void drop_broken_restrictions(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
