#include "osm/repairs/main_road_lanes.h"

#include "osm/ways.h"

namespace sumogamma::osm {

void guess_main_road_lanes(OsmMap& map, IssueLog& log) {
  for (MapWay& way : map.ways) {
    if (!tag_is(way.tags, "highway", {"trunk", "primary"}) || is_one_way(way) ||
        way.tags.contains("lanes"))
      continue;
    way.tags.try_emplace("lanes", "2");
    log.add(Severity::Note, "lanes_guessed",
            "two-way main roads without lanes: one lane a direction", way_name(way));
  }
}

}  // namespace sumogamma::osm
