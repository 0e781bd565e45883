#include "osm/build_network.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "base/error.h"
#include "osm/driving_side.h"
#include "osm/geo_projection.h"
#include "osm/line_ways.h"
#include "osm/map_repairs.h"
#include "osm/netconvert.h"
#include "osm/network_facts.h"
#include "osm/network_file.h"
#include "osm/network_repairs.h"
#include "osm/obstacles.h"
#include "osm/osm_reader.h"
#include "osm/osm_writer.h"
#include "osm/road_types.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

constexpr double kReadMargin =
    200.0;  // [m] read beyond the box, so that stop lines and squares at its edge are seen
constexpr double kLargest = 100e3;  // [m] side of a map that one plane and one netconvert can bear

std::string box_text(const GeoBox& box) {
  char text[128];
  std::snprintf(text, sizeof text, "%.5f,%.5f,%.5f,%.5f", box.west, box.south, box.east, box.north);
  return text;
}

void check_roads(const OsmMap& map, const BuildRequest& request) {
  const bool any = std::any_of(map.ways.begin(), map.ways.end(), [](const MapWay& way) {
    return is_car_way(way) || is_path_way(way);
  });
  if (any) return;
  throw Error(request.map.string(),
              request.bbox ? "holds no roads or paths within --bbox " + box_text(*request.bbox)
                           : std::string("holds no roads or paths (no way with a highway tag "
                                         "that traffic can use)"));
}

/// The place to build: what was asked for, else what the file says it covers, else where its roads
/// lie.
void choose_box(const OsmMap& map, const BuildRequest& request, BuildResult& result) {
  const std::optional<GeoBox> roads = road_extent(map);
  if (request.bbox) {
    const std::optional<GeoBox> covered = map.bounds ? map.bounds : roads;
    if (!covered || !covered->overlaps(*request.bbox))
      throw Error("--bbox " + box_text(*request.bbox),
                  "lies outside the extract" +
                      (covered ? ", which covers " + box_text(*covered) : std::string()) +
                      " (W,S,E,N)");
    result.box = *request.bbox;
  } else if (map.bounds && roads && map.bounds->overlaps(*roads)) {
    result.box = *map.bounds;
    result.box_from_file = true;
  } else {
    check_roads(map, request);
    result.box = *roads;
    result.log.add(Severity::Note, "no_bounds",
                   "the extract does not say what it covers: built whole, nothing cut");
  }
  const LocalMetric metric(result.box.center());
  if ((result.box.east - result.box.west) * metric.meters_per_lon > kLargest ||
      (result.box.north - result.box.south) * metric.meters_per_lat > kLargest)
    throw Error(request.map.string(),
                "covers " + box_text(result.box) +
                    " (W,S,E,N), more than 100 km: cut out a city with --bbox W,S,E,N");
}

void choose_side(const OsmMap& map, const BuildRequest& request, BuildResult& result) {
  const std::string_view region = left_hand_region(result.box.center());
  result.left_hand = request.side == Side::Auto ? !region.empty() : request.side == Side::Left;
  result.side_reason = request.side != Side::Auto ? "asked for"
                       : region.empty() ? "place outside the regions with left-hand traffic"
                                        : "place in region " + std::string(region);
  const RoundaboutTurns turns = count_roundabout_turns(map);
  const int agree = result.left_hand ? turns.clockwise : turns.counter_clockwise;
  const int disagree = result.left_hand ? turns.counter_clockwise : turns.clockwise;
  if (disagree > agree + 1)
    result.log.add(Severity::Warning, "side_doubtful",
                   "most roundabouts turn the other way than traffic on this side would: check, or "
                   "give --side",
                   "", disagree);
}

bool has_layers(const OsmMap& map) {
  return std::any_of(map.ways.begin(), map.ways.end(), [](const MapWay& way) {
    return way.tags.contains("highway") && !tag(way.tags, "layer").empty() &&
           tag(way.tags, "layer") != "0";
  });
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The ways of the map that edges were made of, by edge.
using Origins = std::map<std::string, std::set<std::int64_t>>;

/// Builds net.net.xml; false where it was stopped.
bool convert(const OsmMap& map, const BuildRequest& request, BuildResult& result,
             Origins& origins) {
  NetconvertRequest netconvert;
  netconvert.folder = request.folder;
  std::filesystem::create_directory(request.folder / "work");
  netconvert.projection = result.projection;
  netconvert.left_hand = result.left_hand;
  netconvert.layers = has_layers(map);
  netconvert.should_stop = request.should_stop;
  netconvert.road_types = "work/roads.typ.xml";
  write_prepared_osm(map, request.folder / netconvert.prepared,
                     write_road_types(map, typemaps(), request.folder / netconvert.road_types));
  Conversion conversion;
  std::optional<NetworkFile> network =
      make_network(map, netconvert, request.without, conversion, result.log);
  if (!network) return false;
  origins = ways_of_edges(network->net());
  result.road = std::move(network->road);
  result.command = std::move(conversion.command);
  result.built = std::move(conversion.before);
  std::filesystem::remove_all(request.folder / "work");
  result.netconvert_messages = count_message_kinds(read_text(request.folder / netconvert.log));
  return true;
}

void check_network(BuildResult& result) {
  if (result.built["car_edges"] == 0)
    result.log.add(Severity::Warning, "no_car_roads",
                   "no road for cars: only walking and cycling here");
  if (result.built["car_components"] > 1)
    result.log.add(Severity::Note, "car_components",
                   "parts of the road network that do not join within the map", "",
                   static_cast<long>(result.built["car_components"]));
  const auto wanted = result.read.find("signals");
  if (wanted != result.read.end() && wanted->second > 0 && result.built["signals"] == 0)
    result.log.add(Severity::Warning, "signals_lost",
                   "traffic lights in the map, none in the network", "", wanted->second);
}

/// Objects as the file holds them; signs and lights within the box.
void count_read(const OsmMap& map, BuildResult& result) {
  result.read = map.counts;
  long signals = 0, crossings = 0, roads = 0, paths = 0, mini = 0, give_way = 0;
  for (const auto& [id, node] : map.nodes) {
    if (!result.box.contains(node.place)) continue;
    signals += tag_is(node.tags, "highway", {"traffic_signals"});
    crossings += tag_is(node.tags, "highway", {"crossing"});
    mini += tag_is(node.tags, "highway", {"mini_roundabout"});
    give_way += tag_is(node.tags, "highway", {"give_way", "stop"});
  }
  for (const MapWay& way : map.ways) {
    roads += is_car_way(way);
    paths += is_path_way(way);
  }
  result.read["signals"] = signals;
  result.read["crossing_nodes"] = crossings;
  result.read["mini_roundabouts"] = mini;
  result.read["give_way_and_stop_signs"] = give_way;
  result.read["road_ways"] = roads;
  result.read["path_ways"] = paths;
  result.read["areas"] = static_cast<long>(map.areas.size());
  result.read["turn_restrictions"] = static_cast<long>(map.relations.size());
  if (const auto missing = map.counts.find("missing_nodes");
      missing != map.counts.end() && missing->second > 0)
    result.log.add(Severity::Warning, "missing_nodes",
                   "points of ways that the extract does not hold", "", missing->second);
  if (!map.server_remark.empty())
    result.log.add(
        Severity::Warning, "answer_not_whole",
        "the server that gave this extract says that it is not whole: " + map.server_remark);
  if (!map.bad_place.empty())
    result.log.add(Severity::Warning, "nodes_off_the_earth",
                   "nodes at no place on the earth, left out", map.bad_place,
                   map.counts.at("nodes_without_valid_place"));
}

}  // namespace

BuildResult build_network(const BuildRequest& request) {
  BuildResult result;
  result.without = request.without;
  request.progress("reading " + request.map.filename().string());
  std::optional<GeoBox> keep;
  if (request.bbox) keep = request.bbox->grown(kReadMargin);
  OsmMap map = read_osm(request.map, keep);
  choose_box(map, request, result);
  count_read(map, result);
  check_roads(map, request);
  choose_side(map, request, result);
  result.projection = local_projection(result.box.center());
  const MapLines lines = find_lines(map);
  const std::int64_t first_new_way = map.next_id;
  if (request.should_stop()) return result.stopped = true, std::move(result);

  request.progress("repairing tags, signals and edges");
  const bool clip = request.bbox.has_value() || result.box_from_file;
  repair_map(map, {result.box, clip, result.left_hand}, request.without, result.log);
  check_roads(map, request);

  request.progress("building the network (netconvert)");
  Origins origins;
  if (!convert(map, request, result, origins)) return result.stopped = true, std::move(result);
  result.built.merge(network_facts(result.road));
  check_network(result);
  const GeoProjection projection(result.projection);
  const GeoBox place = clip ? result.box.grown(kBeyondBox) : GeoBox{-180, -90, 180, 90};
  result.transport =
      place_lines({result.road, origins, projection, place, first_new_way}, lines, result.lines);

  request.progress("placing obstacles");
  result.obstacles = write_obstacles(map, projection, result.road, result.box.grown(100.0),
                                     request.folder / "obstacles.add.xml", result.log);
  result.stopped = request.should_stop();
  return result;
}

}  // namespace sumogamma::osm
