#include "osm/repairs/squares.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

/// True where every point of the straight line lies in the ring, looked at in steps.
bool sees(const std::vector<GeoPoint>& ring, GeoPoint from, GeoPoint to) {
  constexpr int kSteps = 20;
  for (int i = 1; i < kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    if (!ring_has(ring,
                  {from.lon + share * (to.lon - from.lon), from.lat + share * (to.lat - from.lat)}))
      return false;
  }
  return true;
}

/// A square is walked across, not round: footways from each entrance to its middle. netconvert
/// would draw a lane along its outline. Where the middle cannot be seen from all entrances the
/// outline stays, as a plain footway.
void replace_square(OsmMap& map, MapWay square, const Uses& uses, std::vector<MapWay>& added,
                    IssueLog& log) {
  std::vector<GeoPoint> ring;
  GeoPoint middle;
  for (std::size_t i = 0; i + 1 < square.nodes.size(); ++i)
    ring.push_back(map.nodes.at(square.nodes[i]).place);
  for (const GeoPoint p : ring) {
    middle.lon += p.lon / static_cast<double>(ring.size());
    middle.lat += p.lat / static_cast<double>(ring.size());
  }
  std::vector<std::int64_t> entrances;
  for (std::size_t i = 0; i + 1 < square.nodes.size(); ++i)
    if (uses.at(square.nodes[i]) > 1) entrances.push_back(square.nodes[i]);
  bool open = ring.size() >= 3 && ring_has(ring, middle);
  for (const std::int64_t entrance : entrances)
    open = open && sees(ring, map.nodes.at(entrance).place, middle);
  if (!open && entrances.size() > 1) {
    square.tags.erase("area");
    square.tags["highway"] = "footway";
    log.add(Severity::Note, "square_kept_as_outline",
            "pedestrian areas with hidden corners, walked along their outline", way_name(square));
    added.push_back(std::move(square));
    return;
  }
  if (entrances.size() < 2) {
    log.add(Severity::Note, "square_without_way_through",
            "pedestrian areas that join nothing, left out of the network", way_name(square));
    return;
  }
  const std::int64_t center = map.new_id();
  map.nodes[center].place = middle;
  for (const std::int64_t entrance : entrances) {
    MapWay spoke{map.new_id(), {entrance, center}, {{"highway", "footway"}}};
    if (square.tags.contains("layer")) spoke.tags["layer"] = tag(square.tags, "layer");
    added.push_back(std::move(spoke));
  }
  log.add(Severity::Note, "square_crossed",
          "pedestrian areas replaced by footways between their entrances", way_name(square));
}

}  // namespace

void replace_squares(OsmMap& map, IssueLog& log) {
  std::vector<MapWay> kept, squares, added;
  for (MapWay& way : map.ways) {
    const bool closed = way.nodes.size() >= 4 && way.nodes.front() == way.nodes.back();
    if (!way.tags.contains("highway") || !closed || !tag_is(way.tags, "area", {"yes"}))
      kept.push_back(std::move(way));
    else if (is_path_way(way))
      squares.push_back(std::move(way));
    else
      log.add(Severity::Note, "dropped_road_area", "road surfaces drawn as areas", way_name(way));
  }
  map.ways = std::move(kept);
  map.ways.insert(map.ways.end(), squares.begin(), squares.end());
  const Uses uses = count_node_uses(map);
  map.ways.resize(map.ways.size() - squares.size());
  for (MapWay& square : squares) replace_square(map, std::move(square), uses, added, log);
  map.ways.insert(map.ways.end(), added.begin(), added.end());
}

}  // namespace sumogamma::osm
