#include "osm/repairs/travelled_ways.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "osm/mode_access.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

constexpr std::string_view kYes[] = {"yes", "designated", "permissive", "public", "official"};
constexpr std::string_view kClosed[] = {"no", "private"};

/// A reason to leave the way out, or nullptr.
const char* reason_to_drop(const MapWay& way) {
  const std::string& layer = tag(way.tags, "layer");
  const bool below = !layer.empty() && layer[0] == '-';
  if (tag_is(way.tags, "indoor", {"yes", "corridor", "area"}) ||
      tag_is(way.tags, "highway", {"corridor", "elevator"}))
    return "indoor";
  if (is_path_way(way) && (tag_is(way.tags, "location", {"underground", "indoor"}) ||
                           tag_is(way.tags, "tunnel", {"yes", "passage"}) || below))
    return "underground_path";
  if (is_car_way(way)) {
    const ModeAccess access = mode_access(way.tags);
    return access.motors || access.bicycle || access.foot ? nullptr : "private";
  }
  if (tag_is(way.tags, "access", kClosed) && !tag_is(way.tags, "foot", kYes) &&
      !tag_is(way.tags, "bicycle", kYes) && !tag_is(way.tags, "motor_vehicle", kYes) &&
      !tag_is(way.tags, "vehicle", kYes))
    return "private";
  if (is_path_way(way) && tag_is(way.tags, "foot", kClosed) &&
      !tag_is(way.tags, "highway", {"cycleway"}) && !tag_is(way.tags, "bicycle", kYes))
    return "private";
  return nullptr;
}

}  // namespace

void drop_untravelled(OsmMap& map, IssueLog& log) {
  std::erase_if(map.ways, [&](MapWay& way) {
    if (!way.tags.contains("highway")) return false;  // walls and buildings: obstacles, not roads
    if (tag_is(way.tags, "highway", {"road"})) {
      way.tags["highway"] = "unclassified";
      log.add(Severity::Note, "road_of_unknown_class", "highway=road taken for unclassified",
              way_name(way));
    } else if (tag_is(way.tags, "highway", {"busway", "bus_guideway"})) {
      way.tags["highway"] = "bus_guideway";
    } else if (!is_car_way(way) && !is_path_way(way)) {
      log.add(Severity::Note, "dropped_not_a_way",
              "highway values that nobody travels (planned, platform, ...)",
              way_name(way) + " " + tag(way.tags, "highway"));
      return true;
    }
    const char* reason = reason_to_drop(way);
    if (reason == nullptr) return false;
    log.add(Severity::Note, std::string("dropped_") + reason,
            std::string("ways left out: ") + reason, way_name(way));
    return true;
  });
}

}  // namespace sumogamma::osm
