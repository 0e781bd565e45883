#include "osm/repairs/added_nodes.h"

#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

void insert(const AddedNodes& added, MapWay& way) {
  std::vector<std::int64_t> nodes;
  for (std::size_t i = 0; i < way.nodes.size(); ++i) {
    if (i > 0) {
      const std::int64_t from = way.nodes[i - 1], to = way.nodes[i];
      if (const auto ahead = added.find({from, to}); ahead != added.end())
        nodes.insert(nodes.end(), ahead->second.begin(), ahead->second.end());
      else if (const auto back = added.find({to, from}); back != added.end())
        nodes.insert(nodes.end(), back->second.rbegin(), back->second.rend());
    }
    nodes.push_back(way.nodes[i]);
  }
  way.nodes = std::move(nodes);
}

}  // namespace

void insert_nodes(const AddedNodes& added, OsmMap& map) {
  for (MapWay& way : map.ways)
    if (is_car_way(way) || is_cycle_way(way)) insert(added, way);
}

bool is_cycle_way(const MapWay& way) { return tag_is(way.tags, "highway", {"cycleway", "path"}); }

}  // namespace sumogamma::osm
