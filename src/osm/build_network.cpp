#include "osm/build_network.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "base/error.h"
#include "osm/backward_turns.h"
#include "osm/carriageways_apart.h"
#include "osm/driving_side.h"
#include "osm/geo_projection.h"
#include "osm/lane_overlap.h"
#include "osm/netconvert.h"
#include "osm/network_facts.h"
#include "osm/obstacles.h"
#include "osm/osm_reader.h"
#include "osm/osm_writer.h"
#include "osm/prepare.h"
#include "osm/right_of_way_tags.h"
#include "osm/road_types.h"
#include "osm/signal_offsets.h"
#include "osm/swallowed_roads.h"
#include "osm/walking_ground.h"
#include "road/sumo_net_reader.h"

namespace sumogamma::osm {
namespace {

constexpr double kReadMargin =
    200.0;  // [m] read beyond the box, so that stop lines and squares at its edge are seen
constexpr double kSignReach = 30.0;  // [m] from a sign to the junction it guards
constexpr double kWorthAnotherPass =
    0.005;  // share of the lanes for wheels that still overlap: another pass takes its time
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

/// Metres of lanes on lanes of other edges, for wheels and for walking, as they stand.
void note_overlap_before(const RoadNetwork& road, BuildResult& result) {
  const OverlapLength before = overlap_length(road, find_lane_overlaps(road));
  result.built["overlapping_lanes_before_m"] = std::round(before.wheels);
  result.built["overlapping_walkways_before_m"] = std::round(before.walking);
}

void note_carriageways(const CarriagewayPlan& plan, BuildResult& result) {
  for (const std::string& edge : plan.apart)
    result.log.add(Severity::Note, "moved_apart",
                   "edges moved sideways because their lanes lay on those of other edges", edge);
  for (const std::string& edge : plan.bends)
    result.log.add(Severity::Note, "bends_widened",
                   "edges at the outside of sharp bends, moved outwards there for long bodies",
                   edge);
  for (const auto& [lane, width] : plan.lane_widths)
    result.log.add(Severity::Note, "lanes_narrowed",
                   "lanes narrowed where there was no room to move edges apart", lane);
  for (const std::string& edge : plan.dropped)
    result.log.add(Severity::Note, "path_on_carriageway",
                   "paths left out that ran lengthwise inside a carriageway", edge);
}

long count_crossings(const RoadNetwork& road) {
  return std::count_if(road.edges.begin(), road.edges.end(),
                       [](const Edge& edge) { return edge.kind == LaneKind::Crossing; });
}

/// Has netconvert apply the patch to `road`, the network as it stands, with carriageways moved
/// apart. The patched network, or nothing where it was stopped.
std::optional<RoadNetwork> patch_apart(const NetconvertRequest& netconvert, const RoadNetwork& road,
                                       NetworkPatch patch, BuildResult& result) {
  const std::filesystem::path network = netconvert.folder / netconvert.network;
  patch.carriageways = plan_carriageways(network, road);
  if (patch.empty()) return road;
  if (patch_network(netconvert, patch).empty()) return std::nullopt;
  note_carriageways(patch.carriageways, result);
  RoadNetwork patched = read_sumo_net(network);
  if (const long lost = count_crossings(road) - count_crossings(patched); lost > 0)
    result.log.add(Severity::Note, "crossings_lost",
                   "crossings for which there is no room, or no use, any more after edges moved",
                   "", lost);
  return patched;
}

/// Has netconvert make one junction of each group as well. Whatever is joined changes what it would
/// join around it by itself: all else stays as it is.
void join(const std::vector<NodeGroup>& groups, NetconvertRequest& netconvert,
          BuildResult& result) {
  if (netconvert.joins.empty())
    netconvert.joins = read_joins(netconvert.folder / netconvert.joined);
  for (const NodeGroup& nodes : groups) {
    result.log.add(Severity::Note, "junctions_joined",
                   "junctions made one because there was no room for the road between them",
                   "node/" + *nodes.begin());
    add_group(nodes, netconvert.joins);
  }
}

/// Runs netconvert on the map, and once more where junctions swallowed the road between them. The
/// network, or nothing where it was stopped.
std::optional<RoadNetwork> convert_map(NetconvertRequest& netconvert, BuildResult& result) {
  const std::filesystem::path network = netconvert.folder / netconvert.network;
  result.command = run_netconvert(netconvert);
  if (result.command.empty()) return std::nullopt;
  RoadNetwork road = read_sumo_net(network);
  const std::vector<NodeGroup> swallowed = swallowed_roads(road);
  if (swallowed.empty()) return road;
  join(swallowed, netconvert, result);
  result.command = run_netconvert(netconvert);
  if (result.command.empty()) return std::nullopt;
  return read_sumo_net(network);
}

/// Sets signals that follow each other closely so that who gets over one gets over the next.
void coordinate_signals(const std::filesystem::path& network, const RoadNetwork& road,
                        BuildResult& result) {
  const auto offsets = signal_offsets(road, read_signal_programs(network));
  if (offsets.empty()) return;
  set_signal_offsets(network, offsets);
  for (const auto& [signal, offset] : offsets)
    result.log.add(Severity::Note, "signals_coordinated",
                   "signals less than 60 m from another that were set to its times",
                   signal + " offset " + std::to_string(offset) + " s");
}

/// Takes the ground that turning vehicles need off the walking areas.
void clear_walking_areas(const std::filesystem::path& network, const RoadNetwork& road,
                         BuildResult& result) {
  const auto outlines = walking_areas_off_the_road(road);
  if (outlines.empty()) return;
  set_walking_areas(network, road, outlines);
  for (const auto& [area, outline] : outlines)
    result.log.add(Severity::Note, "kerbs_rounded",
                   "walking areas cut back to where vehicles turn beside them", area);
}

/// Takes out turns that lead backwards where there is another way. What netconvert builds without
/// them may have others: twice at most. The network, or nothing where it was stopped.
std::optional<RoadNetwork> refuse_backward_turns(const NetconvertRequest& netconvert,
                                                 RoadNetwork road, BuildResult& result) {
  constexpr int kRounds = 2;
  std::vector<ConnectionId> turns = backward_turns(road);
  for (int round = 0; round < kRounds && !turns.empty(); ++round) {
    NetworkPatch patch;
    for (const ConnectionId turn : dispensable_turns(road, turns))
      patch.refused.push_back(named_turn(road, turn));
    if (patch.empty()) break;
    if (patch_network(netconvert, patch).empty()) return std::nullopt;
    for (const Turn& turn : patch.refused)
      result.log.add(Severity::Note, "turns_refused",
                     "turns that would lead backwards over their junction, taken out: there is "
                     "another way",
                     turn.from + " to " + turn.to);
    road = read_sumo_net(netconvert.folder / netconvert.network);
    turns = backward_turns(road);
  }
  for (const ConnectionId turn : turns)
    result.log.add(Severity::Warning, "turn_leads_back",
                   "turns that lead backwards over their junction, the only way there",
                   named_turn(road, turn).from + " to " + named_turn(road, turn).to);
  return road;
}

/// Gives the network, as netconvert made it of the map, what netconvert does not read there, and
/// moves its carriageways apart. The network, or nothing where it was stopped.
std::optional<RoadNetwork> patch(const OsmMap& map, const NetconvertRequest& netconvert,
                                 const RoadNetwork& converted, BuildResult& result) {
  note_overlap_before(converted, result);
  NetworkPatch patch;
  patch.roundabouts = unmarked_roundabouts(netconvert.folder / netconvert.network, map);
  patch.junction_types = stop_types(converted, find_signs(map, "stop", kSignReach));
  for (const auto& [junction, type] : patch.junction_types)
    result.log.add(Severity::Note, "stop_signs",
                   "junctions with stop signs, which netconvert does not read",
                   junction + " " + type);
  for (const std::string& junction : mini_roundabouts(converted, map)) {
    patch.junction_types[junction] = "left_before_right";
    result.log.add(Severity::Note, "mini_roundabout_marked",
                   "mini-roundabouts, where who comes round the middle goes first", junction);
  }
  for (const auto& ring : patch.roundabouts)
    result.log.add(Severity::Note, "roundabout_marked",
                   "roundabouts by tag that netconvert had not seen", ring[0]);
  patch.prohibitions = give_way_rules(netconvert.folder / netconvert.network, converted,
                                      find_signs(map, "give_way", kSignReach));
  std::set<std::string> yielding;
  for (const Prohibition& rule : patch.prohibitions) yielding.insert(rule.waits_from);
  for (const std::string& edge : yielding)
    result.log.add(Severity::Note, "give_way_signs",
                   "roads with give-way signs, which netconvert does not read", edge);
  std::optional<RoadNetwork> road = patch_apart(netconvert, converted, patch, result);
  if (!road) return std::nullopt;
  // edges that lay on each other were partly swallowed by their junctions: only now all of them is
  // there
  const OverlapLength left = overlap_length(*road, find_lane_overlaps(*road));
  if (left.wheels + left.walking > kWorthAnotherPass * left.all_wheels)
    road = patch_apart(netconvert, *road, NetworkPatch{}, result);
  return road ? refuse_backward_turns(netconvert, *std::move(road), result) : std::nullopt;
}

/// The network of the map, made anew with junctions joined where only the finished one tells that
/// they have to be; nothing where it was stopped.
std::optional<RoadNetwork> convert_and_patch(const OsmMap& map, NetconvertRequest& netconvert,
                                             BuildResult& result) {
  std::optional<RoadNetwork> road = convert_map(netconvert, result);
  if (!road) return std::nullopt;
  const BuildResult converted = result;
  road = patch(map, netconvert, *road, result);
  if (!road) return std::nullopt;
  const std::vector<NodeGroup> on_ways = signals_on_ways(*road);
  if (on_ways.empty()) return refuse_backward_turns(netconvert, *std::move(road), result);
  result = converted;  // notes tell of what is built, not of a first attempt
  join(on_ways, netconvert, result);
  road = convert_map(netconvert, result);
  if (road) road = patch(map, netconvert, *road, result);
  return road ? refuse_backward_turns(netconvert, *std::move(road), result) : std::nullopt;
}

/// Builds net.net.xml; false where it was stopped.
bool convert(const OsmMap& map, const BuildRequest& request, BuildResult& result) {
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
  const std::optional<RoadNetwork> road = convert_and_patch(map, netconvert, result);
  if (!road) return false;
  coordinate_signals(request.folder / netconvert.network, *road, result);
  clear_walking_areas(request.folder / netconvert.network, *road, result);
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
  request.progress("reading " + request.map.filename().string());
  std::optional<GeoBox> keep;
  if (request.bbox) keep = request.bbox->grown(kReadMargin);
  OsmMap map = read_osm(request.map, keep);
  choose_box(map, request, result);
  count_read(map, result);
  check_roads(map, request);
  choose_side(map, request, result);
  result.projection = local_projection(result.box.center());
  if (request.should_stop()) return result.stopped = true, std::move(result);

  request.progress("repairing tags, signals and edges");
  PrepareOptions options;
  options.box = result.box;
  options.clip = request.bbox.has_value() || result.box_from_file;
  options.left_hand = result.left_hand;
  prepare_map(map, options, result.log);
  check_roads(map, request);

  request.progress("building the network (netconvert)");
  if (!convert(map, request, result)) return result.stopped = true, std::move(result);
  result.road = read_sumo_net(request.folder / "net.net.xml");
  result.built.merge(network_facts(result.road));
  check_network(result);

  request.progress("placing obstacles");
  result.obstacles =
      write_obstacles(map, GeoProjection(result.projection), result.road, options.box.grown(100.0),
                      request.folder / "obstacles.add.xml", result.log);
  result.stopped = request.should_stop();
  return result;
}

}  // namespace sumogamma::osm
