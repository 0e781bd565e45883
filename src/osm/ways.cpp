#include "osm/ways.h"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace sumogamma::osm {
namespace {

constexpr std::string_view kCarWays[] = {
    "motorway",      "trunk",         "primary",      "secondary",      "tertiary",
    "motorway_link", "trunk_link",    "primary_link", "secondary_link", "tertiary_link",
    "residential",   "living_street", "unclassified", "service"};
constexpr std::string_view kPathWays[] = {"footway",  "pedestrian", "path", "bridleway",
                                          "cycleway", "steps",      "track"};

}  // namespace

bool is_car_way(const MapWay& way) { return tag_is(way.tags, "highway", kCarWays); }
bool is_path_way(const MapWay& way) { return tag_is(way.tags, "highway", kPathWays); }

bool is_one_way(const MapWay& way) {
  if (tag_is(way.tags, "oneway", {"yes", "1", "true", "-1", "reverse"})) return true;
  if (tag_is(way.tags, "oneway", {"no", "0", "false"})) return false;
  return tag_is(way.tags, "junction", {"roundabout", "circular"}) ||
         tag_is(way.tags, "highway", {"motorway"});
}

bool is_reversed(const MapWay& way) { return tag_is(way.tags, "oneway", {"-1", "reverse"}); }

int road_class(const MapWay& way) {
  const std::string& highway = tag(way.tags, "highway");
  const auto* const found = std::find(std::begin(kCarWays), std::end(kCarWays), highway);
  return static_cast<int>(found - std::begin(kCarWays));
}

std::string way_name(const MapWay& way) { return "way/" + std::to_string(way.id); }

Uses count_node_uses(const OsmMap& map) {
  Uses uses;
  for (const MapWay& way : map.ways)
    if (way.tags.contains("highway"))
      for (std::size_t i = 0; i < way.nodes.size(); ++i)
        if (i == 0 || way.nodes[i] != way.nodes[0]) ++uses[way.nodes[i]];
  return uses;
}

}  // namespace sumogamma::osm
