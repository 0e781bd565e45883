#include "osm/repairs/closed_roads.h"

#include "osm/mode_access.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

void close(MapWay& way, IssueLog& log) {
  if (!is_car_way(way)) return;
  const ModeAccess access = mode_access(way.tags);
  if (!access.motors) {
    way.tags["highway"] = access.bicycle ? "path" : "footway";
    log.add(Severity::Note, "closed_to_motors",
            "roads closed to motor vehicles, kept for walking and cycling", way_name(way));
    return;
  }
  if (!access.bicycle) way.tags["bicycle"] = "no";
  if (!access.foot) {
    way.tags["foot"] = "no";
    way.tags.try_emplace("sidewalk", "no");
  }
  if (!access.closed.empty())
    log.add(Severity::Note, "closed_to_some", "roads closed to some kinds of motor vehicles",
            way_name(way));
}

}  // namespace

void close_to_motors(OsmMap& map, IssueLog& log) {
  for (MapWay& way : map.ways) close(way, log);
}

}  // namespace sumogamma::osm
