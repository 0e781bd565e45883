#include "osm/repairs/doubled_roads.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

/// Which directions of a piece are taken, from its smaller to its larger node id and back.
enum Direction : unsigned { kUp = 1, kDown = 2 };
using Taken = std::map<std::pair<std::int64_t, std::int64_t>, unsigned>;

unsigned directions_of(const MapWay& way, std::int64_t from, std::int64_t to) {
  if (!is_car_way(way) || !is_one_way(way)) return kUp | kDown;
  return (from < to) != is_reversed(way) ? kUp : kDown;
}

/// Do people walk along this road? Then a path on top of it is the same way again.
bool is_walked(const MapWay& way) {
  return !tag_is(way.tags, "sidewalk", {"no"}) && !tag_is(way.tags, "foot", {"no"}) &&
         !tag_is(way.tags, "highway", {"motorway", "motorway_link", "trunk", "trunk_link"});
}

/// Takes the pieces of a way that are still free; the runs of nodes that it keeps.
std::vector<std::vector<std::int64_t>> take_pieces(const MapWay& way, Taken& roads, Taken& paths) {
  std::vector<std::vector<std::int64_t>> runs;
  bool goes_on = false;
  for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
    const std::int64_t a = way.nodes[i], b = way.nodes[i + 1];
    const unsigned wanted = directions_of(way, a, b);
    const auto piece = std::minmax(a, b);
    unsigned& taken = (is_car_way(way) ? roads : paths)[piece];
    const bool free = (taken & wanted) != wanted;
    if (free) {
      if (!goes_on) runs.push_back({a});
      runs.back().push_back(b);
      taken |= wanted;
      if (is_car_way(way) && is_walked(way)) paths[piece] = kUp | kDown;
    }
    goes_on = free;
  }
  return runs;
}

}  // namespace

void drop_doubled_roads(OsmMap& map, IssueLog& log) {
  std::vector<std::size_t> best_first;
  for (std::size_t i = 0; i < map.ways.size(); ++i)
    if (is_car_way(map.ways[i]) || is_path_way(map.ways[i])) best_first.push_back(i);
  const auto rank = [&](std::size_t i) {
    const MapWay& way = map.ways[i];
    return std::tuple(!is_car_way(way), is_car_way(way) && is_one_way(way), road_class(way),
                      way.id);
  };
  std::sort(best_first.begin(), best_first.end(),
            [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });

  Taken roads, paths;
  std::vector<MapWay> cut_off;
  for (const std::size_t i : best_first) {
    MapWay& way = map.ways[i];
    auto runs = take_pieces(way, roads, paths);
    if (runs.size() == 1 && runs[0].size() == way.nodes.size()) continue;
    log.add(Severity::Note, "drawn_twice", "ways on top of others, kept once",
            "way/" + std::to_string(way.id));
    way.nodes = runs.empty() ? std::vector<std::int64_t>{} : std::move(runs[0]);
    for (std::size_t k = 1; k < runs.size(); ++k)
      cut_off.push_back({map.new_id(), std::move(runs[k]), way.tags});
  }
  std::erase_if(map.ways, [](const MapWay& way) { return way.nodes.size() < 2; });
  map.ways.insert(map.ways.end(), cut_off.begin(), cut_off.end());
}

}  // namespace sumogamma::osm
