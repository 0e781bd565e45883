#include "osm/repairs/carriageway_ends.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/units.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

/// Bearing of the way as it leaves its first or last node, measured at least 15 m out.
double bearing_out(const OsmMap& map, const MapWay& way, bool from_first) {
  constexpr double kEndReach = 15.0;
  const auto place = [&](std::size_t i) {
    return map.nodes.at(way.nodes[from_first ? i : way.nodes.size() - 1 - i]).place;
  };
  const LocalMetric metric(place(0));
  std::size_t i = 1;
  while (i + 1 < way.nodes.size() && metric.distance(place(0), place(i)) < kEndReach) ++i;
  return metric.bearing(place(0), place(i));
}

struct WayEnd {
  std::size_t way = 0;
  bool first = false;  ///< the way's first node
};

}  // namespace

void split_carriageway_ends(OsmMap& map, const GeoBox& box, IssueLog& log) {
  constexpr double kSharp = radians(75.0);
  constexpr double kApart = 1.5;  // [m]: netconvert merges nodes at one place
  std::map<std::int64_t, std::vector<WayEnd>> ends;
  const Uses uses = count_node_uses(map);
  for (std::size_t i = 0; i < map.ways.size(); ++i) {
    const MapWay& way = map.ways[i];
    if (!is_car_way(way) || !is_one_way(way) || way.nodes.front() == way.nodes.back()) continue;
    ends[way.nodes.front()].push_back({i, true});
    ends[way.nodes.back()].push_back({i, false});
  }
  // a little inside counts as "at the edge": extracts end ways at the first node beyond it
  const GeoBox inner = box.grown(-5.0);
  for (const auto& [node, pair] : ends) {
    if (pair.size() != 2 || uses.at(node) != 2 || pair[0].first == pair[1].first) continue;
    if (inner.contains(map.nodes.at(node).place)) continue;
    MapWay &a = map.ways[pair[0].way], &b = map.ways[pair[1].way];
    if (tag(a.tags, "name") != tag(b.tags, "name") || is_reversed(a) != is_reversed(b)) continue;
    const double angle = std::abs(
        wrap_angle(bearing_out(map, a, pair[0].first) - bearing_out(map, b, pair[1].first)));
    if (angle >= kSharp) continue;
    const GeoPoint here = map.nodes.at(node).place;
    const LocalMetric metric(here);
    const double bearing = bearing_out(map, b, pair[1].first);
    const std::int64_t copy = map.new_id();
    map.nodes[copy].place = metric.place(kApart * std::cos(bearing), kApart * std::sin(bearing));
    (pair[1].first ? b.nodes.front() : b.nodes.back()) = copy;
    log.add(Severity::Note, "carriageways_separated",
            "ends where two carriageways met in one point, now apart",
            "node/" + std::to_string(node));
  }
}
}  // namespace sumogamma::osm
