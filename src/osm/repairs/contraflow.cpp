#include "osm/repairs/contraflow.h"

#include <array>
#include <string>

#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

constexpr std::array kCycleways = {"cycleway", "cycleway:both", "cycleway:left", "cycleway:right"};

bool is_opposite(const std::string& value) { return value.starts_with("opposite"); }

/// "track" or "lane" where the value tells of a way for bicycles, else "".
std::string kind_of(const std::string& value) {
  if (value.ends_with("track")) return "track";
  if (value.ends_with("lane") || value == "yes" || value == "opposite") return "lane";
  return "";
}

/// What bicycles have in a one-way road: a lane along with the traffic, one against it; "" none.
struct BicycleLanes {
  std::string along, against;
};

BicycleLanes bicycle_lanes(const Tags& tags, const std::string& oncoming_side) {
  const bool both_ways = tag_is(tags, "oneway:bicycle", {"no", "-1", "false", "0"});
  BicycleLanes lanes;
  for (const char* key : kCycleways) {
    const std::string& value = tag(tags, key);
    const std::string kind = kind_of(value), name = key;
    if (kind.empty()) continue;
    const bool oncoming = name == "cycleway:" + oncoming_side;
    const bool turned = tag_is(tags, name + ":oneway", {"-1", "no"});
    if (is_opposite(value) || turned || (oncoming && both_ways))
      lanes.against = kind;
    else
      lanes.along = kind;
  }
  if (both_ways && lanes.against.empty())
    lanes.against = lanes.along.empty() ? "lane" : lanes.along;
  return lanes;
}

}  // namespace

void rewrite_contraflow(OsmMap& map, bool left_hand, IssueLog& log) {
  for (MapWay& way : map.ways) {
    if (!is_car_way(way) || !is_one_way(way)) continue;
    // netconvert's "right" is along the way's nodes, whatever the side of the road
    const bool reversed = is_reversed(way);
    const std::string along = reversed ? "left" : "right", against = reversed ? "right" : "left";
    const std::string name = "way/" + std::to_string(way.id);
    const std::string oncoming = left_hand != reversed ? "right" : "left";
    const BicycleLanes lanes = bicycle_lanes(way.tags, oncoming);
    const bool astray = !kind_of(tag(way.tags, "cycleway:" + oncoming)).empty();
    if (astray || !lanes.against.empty()) {
      for (const char* key : kCycleways)
        if (!kind_of(tag(way.tags, key)).empty()) way.tags.erase(key);
      way.tags.erase("oneway:bicycle");
      if (!lanes.along.empty()) way.tags["cycleway:" + along] = lanes.along;
    }
    if (!lanes.against.empty() && !tag_is(way.tags, "bicycle", {"no", "use_sidepath"})) {
      way.tags["cycleway:" + against] = lanes.against;
      log.add(Severity::Note, "bicycle_contraflow",
              "one-way roads with a lane for bicycles against the traffic", name);
    }
    if (tag_is(way.tags, "oneway:bus", {"no", "-1"}) ||
        tag_is(way.tags, "oneway:psv", {"no", "-1"})) {
      way.tags["busway"] = "opposite_lane";
      log.add(Severity::Note, "bus_contraflow",
              "one-way roads with a lane for buses against the traffic", name);
    }
  }
}

}  // namespace sumogamma::osm
