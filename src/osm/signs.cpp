#include "osm/signs.h"

#include "osm/traffic_graph.h"

namespace sumogamma::osm {

SignsByJunction find_signs(const OsmMap& map, const char* kind, double reach) {
  const TrafficGraph graph(map);
  SignsByJunction signs;
  for (const auto& [id, node] : map.nodes) {
    if (!tag_is(node.tags, "highway", {kind}) || !graph.known(id)) continue;
    std::int64_t target = 0;
    double nearest = reach;
    WayApproach approach;
    for (const Step& exit : graph.exits(id)) {
      double distance = 0;
      if (!faces(node.tags, exit.direction)) continue;
      Step last;
      const std::int64_t junction = graph.junction_ahead(exit, reach, distance, &last);
      if (junction == 0 || distance > nearest) continue;
      target = junction;
      nearest = distance;
      approach = {last.way->id, last.direction};
    }
    if (target != 0) signs[target].push_back(approach);
  }
  return signs;
}

}  // namespace sumogamma::osm
