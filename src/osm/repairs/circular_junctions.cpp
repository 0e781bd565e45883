#include "osm/repairs/circular_junctions.h"

#include "osm/ways.h"

namespace sumogamma::osm {

void mark_circular_as_roundabout(OsmMap& map, IssueLog& log) {
  for (MapWay& way : map.ways) {
    if (!way.tags.contains("highway") || !tag_is(way.tags, "junction", {"circular"})) continue;
    way.tags["junction"] = "roundabout";
    log.add(Severity::Note, "circular_as_roundabout", "junction=circular taken for a roundabout",
            way_name(way));
  }
}

}  // namespace sumogamma::osm
