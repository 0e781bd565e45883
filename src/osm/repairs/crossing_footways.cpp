#include "osm/repairs/crossing_footways.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/units.h"
#include "osm/traffic_graph.h"
#include "osm/ways.h"

namespace sumogamma::osm {

void add_footways_at_crossings(OsmMap& map, IssueLog& log) {
  constexpr double kNearJunction = 15.0,
                   kReach = 9.0;  // [m]; the footway reaches over half a road and its sidewalk
  const TrafficGraph graph(map);
  const Uses uses = count_node_uses(map);
  std::vector<MapWay> added;
  std::vector<std::int64_t> crossings;
  for (const auto& [id, node] : map.nodes) {
    const bool crossing =
        tag_is(node.tags, "highway", {"crossing"}) ||
        (tag_is(node.tags, "highway", {"traffic_signals"}) && node.tags.contains("crossing"));
    if (!crossing || tag_is(node.tags, "crossing", {"no"}) || !graph.known(id)) continue;
    // two arms that are all of its uses: in the middle of a road, and no footway there
    const auto& arms = graph.arms(id);
    if (arms.size() != 2 || uses.at(id) != (arms[0].way == arms[1].way ? 1 : 2)) continue;
    if (tag_is(arms[0].way->tags, "highway", {"motorway", "motorway_link", "service"})) continue;
    if (!graph.junction_within(id, kNearJunction)) crossings.push_back(id);
  }
  for (const std::int64_t id : crossings) {
    const auto& arms = graph.arms(id);
    const auto beside = [&](const Step& arm) {
      return map.nodes.at(arm.way->nodes[arm.direction > 0 ? arm.index + 1 : arm.index - 1]).place;
    };
    const GeoPoint here = map.nodes.at(id).place;
    const LocalMetric metric(here);
    const double along = metric.bearing(beside(arms[0]), beside(arms[1]));
    for (const double side : {kPi / 2, -kPi / 2}) {
      const std::int64_t end = map.new_id();
      map.nodes[end].place =
          metric.place(kReach * std::cos(along + side), kReach * std::sin(along + side));
      added.push_back({map.new_id(), {end, id}, {{"highway", "footway"}}});
    }
    log.add(Severity::Note, "crossing_kept",
            "crossings half way along a road, given footways so that SUMO builds them",
            "node/" + std::to_string(id));
  }
  map.ways.insert(map.ways.end(), added.begin(), added.end());
}
}  // namespace sumogamma::osm
