#include "osm/repairs/unruled_junctions.h"

#include <algorithm>

namespace sumogamma::osm {

std::vector<NodeGroup> unruled_junctions(const RoadNetwork& road,
                                         const std::vector<NodeGroup>& joined) {
  std::vector<NodeGroup> unruled;
  for (const Junction& junction : road.junctions) {
    const NodeGroup named = nodes_of(junction.name);
    if (junction.type != "unregulated" || named.size() < 2) continue;
    // its name leaves out some of its nodes
    const auto made_of = std::find_if(joined.begin(), joined.end(), [&](const NodeGroup& group) {
      return group.contains(*named.begin());
    });
    if (made_of != joined.end()) unruled.push_back(*made_of);
  }
  return unruled;
}

}  // namespace sumogamma::osm
