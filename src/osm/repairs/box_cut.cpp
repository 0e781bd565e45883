#include "osm/repairs/box_cut.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/segment.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

/// The node at `share` of the segment, or the segment's own end where that is within a metre.
std::int64_t node_on_edge(OsmMap& map, std::int64_t from, std::int64_t to, double share) {
  const GeoPoint a = map.nodes.at(from).place, b = map.nodes.at(to).place;
  const double length = LocalMetric(a).distance(a, b);
  if (share * length < 1.0) return from;
  if ((1 - share) * length < 1.0) return to;
  const std::int64_t id = map.new_id();
  map.nodes[id].place = {a.lon + share * (b.lon - a.lon), a.lat + share * (b.lat - a.lat)};
  return id;
}

std::vector<std::vector<std::int64_t>> clip_way(OsmMap& map, const MapWay& way, const GeoBox& box) {
  std::vector<std::vector<std::int64_t>> pieces;
  std::vector<std::int64_t> piece;
  auto finish = [&] {
    if (piece.size() >= 2) pieces.push_back(piece);
    piece.clear();
  };
  for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
    const GeoPoint a = map.nodes.at(way.nodes[i]).place, b = map.nodes.at(way.nodes[i + 1]).place;
    const std::optional<Stretch> inside = stretch_in_box(
        {a.lon, a.lat}, {b.lon, b.lat}, {box.west, box.south}, {box.east, box.north});
    if (!inside) {
      finish();
      continue;
    }
    const auto [enter, leave] = *inside;
    const std::int64_t first =
        enter > 0 ? node_on_edge(map, way.nodes[i], way.nodes[i + 1], enter) : way.nodes[i];
    const std::int64_t last =
        leave < 1 ? node_on_edge(map, way.nodes[i], way.nodes[i + 1], leave) : way.nodes[i + 1];
    if (enter > 0 || piece.empty()) {
      finish();
      piece.push_back(first);
    }
    if (piece.back() != last) piece.push_back(last);
    if (leave < 1) finish();
  }
  finish();
  return pieces;
}

}  // namespace

void cut_at_box(OsmMap& map, const GeoBox& box, IssueLog& log) {
  std::vector<MapWay> kept;
  for (MapWay& way : map.ways) {
    const bool inside = std::all_of(way.nodes.begin(), way.nodes.end(), [&](std::int64_t id) {
      return box.contains(map.nodes.at(id).place);
    });
    if (inside || !way.tags.contains("highway")) {
      kept.push_back(std::move(way));
      continue;
    }
    const auto pieces = clip_way(map, way, box);
    if (pieces.empty())
      log.add(Severity::Note, "dropped_outside", "ways outside the box", way_name(way));
    else
      log.add(Severity::Note, "cut_at_box", "ways cut at the edge of the box", way_name(way));
    for (std::size_t i = 0; i < pieces.size(); ++i)
      kept.push_back({i == 0 ? way.id : map.new_id(), pieces[i], way.tags});
  }
  map.ways = std::move(kept);
}
}  // namespace sumogamma::osm
