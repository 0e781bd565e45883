#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Cuts ways at the box: pieces outside vanish, new nodes stand on its edge (never within 1 m of
/// another node: netconvert would merge them). The first piece keeps the way's id.
void cut_at_box(OsmMap& map, const GeoBox& box, IssueLog& log);

}  // namespace sumogamma::osm
