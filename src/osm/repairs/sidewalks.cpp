#include "osm/repairs/sidewalks.h"

#include <string>
#include <string_view>

#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

/// sidewalk:left/right/both and sidewalk=separate, which 1.15 ignores or takes for "both".
void rewrite(MapWay& way, IssueLog& log) {
  auto present = [&](std::string_view key) { return tag_is(way.tags, key, {"yes"}); };
  auto known = [&](std::string_view key) { return way.tags.contains(key); };
  const std::string before = tag(way.tags, "sidewalk");
  std::string side = before;
  if (known("sidewalk:both") || known("sidewalk:left") || known("sidewalk:right")) {
    const bool left = present("sidewalk:both") || present("sidewalk:left");
    const bool right = present("sidewalk:both") || present("sidewalk:right");
    side = left && right ? "both" : left ? "left" : right ? "right" : "no";
  }
  if (side == "separate" || side == "none") side = "no";
  if (side == "yes") side = "both";
  // nobody walks through a road tunnel unless the map says so, on its lanes neither
  if (before.empty() && side.empty() && tag_is(way.tags, "tunnel", {"yes"})) {
    side = "no";
    way.tags.try_emplace("foot", "no");
  }
  if (side == before) return;
  way.tags["sidewalk"] = side;
  log.add(Severity::Note, "sidewalk_rewritten", "sidewalk tags rewritten for netconvert 1.15",
          way_name(way));
}

}  // namespace

void rewrite_sidewalks(OsmMap& map, IssueLog& log) {
  for (MapWay& way : map.ways)
    if (is_car_way(way)) rewrite(way, log);
}

}  // namespace sumogamma::osm
