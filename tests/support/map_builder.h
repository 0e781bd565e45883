#pragma once

#include <cmath>
#include <initializer_list>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Maps for tests, in metres east and north of 48 N, 11 E.
class MapBuilder {
 public:
  GeoPoint at(double east, double north) const { return metric_.place(east, north); }
  MapBuilder& node(std::int64_t id, double east, double north, Tags tags = {}) {
    map.nodes[id] = {at(east, north), std::move(tags)};
    map.next_id = std::max(map.next_id, id + 1);
    return *this;
  }
  MapBuilder& way(std::int64_t id, std::vector<std::int64_t> nodes, Tags tags) {
    map.ways.push_back({id, std::move(nodes), std::move(tags)});
    map.next_id = std::max(map.next_id, id + 1);
    return *this;
  }
  /// Box from south-west to north-east [m].
  GeoBox box(double west, double south, double east, double north) const {
    const GeoPoint low = at(west, south), high = at(east, north);
    return {low.lon, low.lat, high.lon, high.lat};
  }
  double east(std::int64_t id) const { return metric_.east(map.nodes.at(id).place); }
  double north(std::int64_t id) const { return metric_.north(map.nodes.at(id).place); }
  const MapWay* find_way(std::int64_t id) const {
    for (const MapWay& way : map.ways)
      if (way.id == id) return &way;
    return nullptr;
  }

  GeoPoint origin{11.0, 48.0};
  OsmMap map;
  IssueLog log;

 private:
  LocalMetric metric_{GeoPoint{11.0, 48.0}};
};

/*            5
              |
   2 --s11--> 1 <--s12-- 3      stop lines 30 m out
              |
              4                                       */
inline MapBuilder crossroads_with_stop_lines() {
  const Tags street = {{"highway", "residential"}};
  MapBuilder b;
  b.node(1, 0, 0).node(2, -150, 0).node(3, 150, 0).node(4, 0, -150).node(5, 0, 150);
  b.node(11, -30, 0, {{"highway", "traffic_signals"}})
      .node(12, 30, 0, {{"highway", "traffic_signals"}});
  b.way(101, {2, 11, 1}, street)
      .way(102, {1, 12, 3}, street)
      .way(103, {4, 1}, street)
      .way(104, {1, 5}, street);
  return b;
}

}  // namespace sumogamma::osm
