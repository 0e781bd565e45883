#include "osm/repairs/stop_line_signals.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "osm/traffic_graph.h"
#include "osm/ways.h"

namespace sumogamma::osm {

void move_signals_to_junctions(OsmMap& map, double reach, IssueLog& log) {
  const TrafficGraph graph(map);
  std::vector<std::pair<std::int64_t, std::int64_t>> moves;
  for (const auto& [id, node] : map.nodes) {
    if (!tag_is(node.tags, "highway", {"traffic_signals"})) continue;
    if (graph.is_junction(id)) continue;
    const std::string name = "node/" + std::to_string(id);
    const std::vector<Step> exits = graph.exits(id);
    if (exits.empty()) continue;
    if (tag_is(node.tags, "crossing", {"traffic_signals"})) {
      log.add(Severity::Note, "signal_at_crossing",
              "signalled crossings between junctions, kept in place", name);
      continue;
    }
    std::int64_t target = 0;
    double nearest = reach;
    for (const Step& exit : exits) {
      double distance = 0;
      if (!faces(node.tags, exit.direction)) continue;
      const std::int64_t junction = graph.junction_ahead(exit, reach, distance);
      if (junction != 0 && distance <= nearest) {
        target = junction;
        nearest = distance;
      }
    }
    if (target == 0)
      log.add(Severity::Note, "signal_without_junction",
              "signals with no junction ahead, kept in place", name);
    else
      moves.emplace_back(id, target);
  }
  for (const auto& [from, to] : moves) {
    map.nodes.at(from).tags.erase("highway");
    map.nodes.at(to).tags["highway"] = "traffic_signals";
    log.add(Severity::Note, "signal_moved",
            "signals on stop lines moved to the junction that they guard",
            "node/" + std::to_string(from));
  }
}
}  // namespace sumogamma::osm
