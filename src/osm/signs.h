#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Traffic that comes to a junction along a way, in its direction (1) or against it (-1).
struct WayApproach {
  std::int64_t way = 0;
  int direction = 1;
  bool operator==(const WayApproach&) const = default;
};

/// By the junction's node: approaches that have a sign.
using SignsByJunction = std::map<std::int64_t, std::vector<WayApproach>>;

/// The signs, nodes with highway=`kind` ("stop", "give_way"), on approaches at most `reach` before
/// their junctions [m]. netconvert 1.15 reads neither; see NetworkPatch.
SignsByJunction find_signs(const OsmMap& map, const char* kind, double reach);

}  // namespace sumogamma::osm
