#include "osm/prepare.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/units.h"
#include "osm/contraflow.h"
#include "osm/doubled_roads.h"
#include "osm/mode_access.h"
#include "osm/round_bends.h"
#include "osm/tag_values.h"

namespace sumogamma::osm {
namespace {

constexpr std::string_view kCarWays[] = {
    "motorway",      "trunk",         "primary",      "secondary",      "tertiary",
    "motorway_link", "trunk_link",    "primary_link", "secondary_link", "tertiary_link",
    "residential",   "living_street", "unclassified", "service"};
constexpr std::string_view kPathWays[] = {"footway",  "pedestrian", "path", "bridleway",
                                          "cycleway", "steps",      "track"};
constexpr std::string_view kYes[] = {"yes", "designated", "permissive", "public", "official"};
constexpr std::string_view kClosed[] = {"no", "private"};

std::string way_name(const MapWay& way) { return "way/" + std::to_string(way.id); }

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

/// Roads that motors may not enter become paths for those who may; where some of them may they stay
/// roads, whose type shuts out the others (road_types.h).
void close_to_motors(MapWay& way, IssueLog& log) {
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

using Uses = std::map<std::int64_t, int>;

Uses count_node_uses(const OsmMap& map) {
  Uses uses;
  for (const MapWay& way : map.ways)
    if (way.tags.contains("highway"))
      for (std::size_t i = 0; i < way.nodes.size(); ++i)
        if (i == 0 || way.nodes[i] != way.nodes[0]) ++uses[way.nodes[i]];
  return uses;
}

bool ring_contains(const std::vector<GeoPoint>& ring, GeoPoint p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const GeoPoint a = ring[i], b = ring[j];
    if ((a.lat > p.lat) != (b.lat > p.lat) &&
        p.lon < a.lon + (p.lat - a.lat) / (b.lat - a.lat) * (b.lon - a.lon))
      inside = !inside;
  }
  return inside;
}

/// True where every point of the straight line lies in the ring, looked at in steps.
bool sees(const std::vector<GeoPoint>& ring, GeoPoint from, GeoPoint to) {
  constexpr int kSteps = 20;
  for (int i = 1; i < kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    if (!ring_contains(
            ring, {from.lon + share * (to.lon - from.lon), from.lat + share * (to.lat - from.lat)}))
      return false;
  }
  return true;
}

/// A square is walked across, not round: footways from each entrance to its middle. netconvert
/// would draw a lane along its outline. Where the middle cannot be seen from all entrances the
/// outline stays, as a plain footway.
void replace_square(OsmMap& map, MapWay square, const Uses& uses, std::vector<MapWay>& added,
                    IssueLog& log) {
  std::vector<GeoPoint> ring;
  GeoPoint middle;
  for (std::size_t i = 0; i + 1 < square.nodes.size(); ++i)
    ring.push_back(map.nodes.at(square.nodes[i]).place);
  for (const GeoPoint p : ring) {
    middle.lon += p.lon / static_cast<double>(ring.size());
    middle.lat += p.lat / static_cast<double>(ring.size());
  }
  std::vector<std::int64_t> entrances;
  for (std::size_t i = 0; i + 1 < square.nodes.size(); ++i)
    if (uses.at(square.nodes[i]) > 1) entrances.push_back(square.nodes[i]);
  bool open = ring.size() >= 3 && ring_contains(ring, middle);
  for (const std::int64_t entrance : entrances)
    open = open && sees(ring, map.nodes.at(entrance).place, middle);
  if (!open && entrances.size() > 1) {
    square.tags.erase("area");
    square.tags["highway"] = "footway";
    log.add(Severity::Note, "square_kept_as_outline",
            "pedestrian areas with hidden corners, walked along their outline", way_name(square));
    added.push_back(std::move(square));
    return;
  }
  if (entrances.size() < 2) {
    log.add(Severity::Note, "square_without_way_through",
            "pedestrian areas that join nothing, left out of the network", way_name(square));
    return;
  }
  const std::int64_t center = map.new_id();
  map.nodes[center].place = middle;
  for (const std::int64_t entrance : entrances) {
    MapWay spoke{map.new_id(), {entrance, center}, {{"highway", "footway"}}};
    if (square.tags.contains("layer")) spoke.tags["layer"] = tag(square.tags, "layer");
    added.push_back(std::move(spoke));
  }
  log.add(Severity::Note, "square_crossed",
          "pedestrian areas replaced by footways between their entrances", way_name(square));
}

}  // namespace

bool is_car_way(const MapWay& way) { return tag_is(way.tags, "highway", kCarWays); }
bool is_path_way(const MapWay& way) { return tag_is(way.tags, "highway", kPathWays); }

void select_ways(OsmMap& map, IssueLog& log) {
  std::vector<MapWay> kept, squares;
  for (MapWay& way : map.ways) {
    if (!way.tags.contains("highway")) {
      kept.push_back(std::move(way));  // walls and buildings: obstacles, not roads
      continue;
    }
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
      continue;
    }
    if (const char* reason = reason_to_drop(way)) {
      log.add(Severity::Note, std::string("dropped_") + reason,
              std::string("ways left out: ") + reason, way_name(way));
      continue;
    }
    close_to_motors(way, log);
    const bool closed = way.nodes.size() >= 4 && way.nodes.front() == way.nodes.back();
    if (tag_is(way.tags, "area", {"yes"}) && closed) {
      if (is_path_way(way))
        squares.push_back(std::move(way));
      else
        log.add(Severity::Note, "dropped_road_area", "road surfaces drawn as areas", way_name(way));
      continue;
    }
    kept.push_back(std::move(way));
  }
  map.ways = std::move(kept);
  for (const MapWay& square : squares) map.ways.push_back(square);
  const Uses uses = count_node_uses(map);
  map.ways.resize(map.ways.size() - squares.size());
  std::vector<MapWay> added;
  for (MapWay& square : squares) replace_square(map, std::move(square), uses, added, log);
  map.ways.insert(map.ways.end(), added.begin(), added.end());
}

namespace {

/// sidewalk:left/right/both and sidewalk=separate, which 1.15 ignores or takes for "both".
void normalise_sidewalk(MapWay& way, IssueLog& log) {
  if (!is_car_way(way)) return;
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

namespace {

/// "a||c" for "c||a".
std::string reversed_list(const std::string& list) {
  std::string reversed;
  for (std::size_t end = list.size();;) {
    const std::size_t bar = end == 0 ? std::string::npos : list.rfind('|', end - 1);
    const std::size_t begin = bar == std::string::npos ? 0 : bar + 1;
    reversed += list.substr(begin, end - begin);
    if (begin == 0) return reversed;
    reversed += '|';
    end = bar;
  }
}

}  // namespace

void normalise_tags(OsmMap& map, IssueLog& log) {
  for (MapWay& way : map.ways) {
    if (!way.tags.contains("highway")) continue;
    normalise_sidewalk(way, log);
    if (tag_is(way.tags, "junction", {"circular"})) {
      way.tags["junction"] = "roundabout";
      log.add(Severity::Note, "circular_as_roundabout", "junction=circular taken for a roundabout",
              way_name(way));
    }
    if (tag_is(way.tags, "highway", {"trunk", "primary"}) && !is_one_way(way) &&
        !way.tags.contains("lanes")) {
      way.tags["lanes"] = "2";
      log.add(Severity::Note, "lanes_guessed",
              "two-way main roads without lanes: one lane a direction", way_name(way));
    }
    for (const char* key : {"bus:lanes", "psv:lanes", "bicycle:lanes", "width:lanes", "width"})
      if (is_car_way(way) && way.tags.contains(key))
        log.add(Severity::Note, std::string("ignored_") + key, "tags that SUMO 1.15 does not read",
                way_name(way));
  }
}

void reverse_turn_lanes(OsmMap& map, IssueLog& log) {
  for (MapWay& way : map.ways)
    for (const char* key : {"turn:lanes", "turn:lanes:forward", "turn:lanes:backward"}) {
      const auto found = way.tags.find(key);
      if (found == way.tags.end()) continue;
      found->second = reversed_list(found->second);
      log.add(Severity::Note, "turn_lanes_reversed",
              "turn lanes that netconvert 1.15 reads in the wrong order where traffic keeps left",
              way_name(way));
    }
}

namespace {

/// Share of the segment a-b at which it enters and leaves the box (Liang and Barsky, 1984); false
/// where it misses.
bool clip_segment(const GeoBox& box, GeoPoint a, GeoPoint b, double& enter, double& leave) {
  enter = 0;
  leave = 1;
  const double dx = b.lon - a.lon, dy = b.lat - a.lat;
  const double p[4] = {-dx, dx, -dy, dy};
  const double q[4] = {a.lon - box.west, box.east - a.lon, a.lat - box.south, box.north - a.lat};
  for (int i = 0; i < 4; ++i) {
    if (p[i] == 0) {
      if (q[i] < 0) return false;
      continue;
    }
    const double share = q[i] / p[i];
    if (p[i] < 0)
      enter = std::max(enter, share);
    else
      leave = std::min(leave, share);
  }
  return enter < leave;
}

/// The node at `share` of the segment, or the segment's own end where that is within a metre.
std::int64_t node_on_edge(OsmMap& map, std::int64_t from, std::int64_t to, double share) {
  const GeoPoint a = map.nodes.at(from).place, b = map.nodes.at(to).place;
  const double length = LocalMetric(a).distance(a, b);
  if (share * length < 1.0) return from;
  if ((1 - share) * length < 1.0) return to;
  const std::int64_t id = map.new_id();
  map.nodes[id].place = {a.lon + share * (b.lon - a.lon), a.lat + share * (b.lat - a.lat)};
  return id;
}

std::vector<std::vector<std::int64_t>> clip_way(OsmMap& map, const MapWay& way, const GeoBox& box) {
  std::vector<std::vector<std::int64_t>> pieces;
  std::vector<std::int64_t> piece;
  auto finish = [&] {
    if (piece.size() >= 2) pieces.push_back(piece);
    piece.clear();
  };
  for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
    const GeoPoint a = map.nodes.at(way.nodes[i]).place, b = map.nodes.at(way.nodes[i + 1]).place;
    double enter = 0, leave = 1;
    if (!clip_segment(box, a, b, enter, leave)) {
      finish();
      continue;
    }
    const std::int64_t first =
        enter > 0 ? node_on_edge(map, way.nodes[i], way.nodes[i + 1], enter) : way.nodes[i];
    const std::int64_t last =
        leave < 1 ? node_on_edge(map, way.nodes[i], way.nodes[i + 1], leave) : way.nodes[i + 1];
    if (enter > 0 || piece.empty()) {
      finish();
      piece.push_back(first);
    }
    if (piece.back() != last) piece.push_back(last);
    if (leave < 1) finish();
  }
  finish();
  return pieces;
}

}  // namespace

void clip_ways(OsmMap& map, const GeoBox& box, IssueLog& log) {
  std::vector<MapWay> kept;
  for (MapWay& way : map.ways) {
    const bool inside = std::all_of(way.nodes.begin(), way.nodes.end(), [&](std::int64_t id) {
      return box.contains(map.nodes.at(id).place);
    });
    if (inside || !way.tags.contains("highway")) {
      kept.push_back(std::move(way));
      continue;
    }
    const auto pieces = clip_way(map, way, box);
    if (pieces.empty())
      log.add(Severity::Note, "dropped_outside", "ways outside the box", way_name(way));
    else
      log.add(Severity::Note, "cut_at_box", "ways cut at the edge of the box", way_name(way));
    for (std::size_t i = 0; i < pieces.size(); ++i)
      kept.push_back({i == 0 ? way.id : map.new_id(), pieces[i], way.tags});
  }
  map.ways = std::move(kept);
}

namespace {

/// Bearing of the way as it leaves its first or last node, measured at least 15 m out.
double bearing_out(const OsmMap& map, const MapWay& way, bool from_first) {
  constexpr double kReach = 15.0;
  const auto place = [&](std::size_t i) {
    return map.nodes.at(way.nodes[from_first ? i : way.nodes.size() - 1 - i]).place;
  };
  const LocalMetric metric(place(0));
  std::size_t i = 1;
  while (i + 1 < way.nodes.size() && metric.distance(place(0), place(i)) < kReach) ++i;
  return metric.bearing(place(0), place(i));
}

struct WayEnd {
  std::size_t way = 0;
  bool first = false;  ///< the way's first node
};

}  // namespace

void split_carriageway_ends(OsmMap& map, const GeoBox& box, IssueLog& log) {
  constexpr double kSharp = radians(75.0);
  constexpr double kApart = 1.5;  // [m]: netconvert merges nodes at one place
  std::map<std::int64_t, std::vector<WayEnd>> ends;
  const Uses uses = count_node_uses(map);
  for (std::size_t i = 0; i < map.ways.size(); ++i) {
    const MapWay& way = map.ways[i];
    if (!is_car_way(way) || !is_one_way(way) || way.nodes.front() == way.nodes.back()) continue;
    ends[way.nodes.front()].push_back({i, true});
    ends[way.nodes.back()].push_back({i, false});
  }
  // a little inside counts as "at the edge": extracts end ways at the first node beyond it
  const GeoBox inner = box.grown(-5.0);
  for (const auto& [node, pair] : ends) {
    if (pair.size() != 2 || uses.at(node) != 2 || pair[0].first == pair[1].first) continue;
    if (inner.contains(map.nodes.at(node).place)) continue;
    MapWay &a = map.ways[pair[0].way], &b = map.ways[pair[1].way];
    if (tag(a.tags, "name") != tag(b.tags, "name") || is_reversed(a) != is_reversed(b)) continue;
    const double angle = std::abs(
        wrap_angle(bearing_out(map, a, pair[0].first) - bearing_out(map, b, pair[1].first)));
    if (angle >= kSharp) continue;
    const GeoPoint here = map.nodes.at(node).place;
    const LocalMetric metric(here);
    const double bearing = bearing_out(map, b, pair[1].first);
    const std::int64_t copy = map.new_id();
    map.nodes[copy].place = metric.place(kApart * std::cos(bearing), kApart * std::sin(bearing));
    (pair[1].first ? b.nodes.front() : b.nodes.back()) = copy;
    log.add(Severity::Note, "carriageways_separated",
            "ends where two carriageways met in one point, now apart",
            "node/" + std::to_string(node));
  }
}

namespace {

/// One step out of a node along a way, in a direction that traffic may go.
struct Step {
  const MapWay* way = nullptr;
  std::size_t index = 0;  ///< of the node in the way
  int direction = 1;      ///< +1 towards the way's last node
};

/// Car ways by node, for walking along the traffic.
class TrafficGraph {
 public:
  explicit TrafficGraph(const OsmMap& map) : map_(map) {
    for (const MapWay& way : map.ways) {
      if (!is_car_way(way)) continue;
      for (std::size_t i = 0; i < way.nodes.size(); ++i) {
        const bool closing = i + 1 == way.nodes.size() && way.nodes[i] == way.nodes[0];
        if (i > 0) add(way, i, -1);
        if (i + 1 < way.nodes.size() && !closing) add(way, i, 1);
      }
    }
  }
  bool is_junction(std::int64_t node) const {
    const auto found = arms_.find(node);
    return found != arms_.end() && found->second.size() >= 3 && inputs_.at(node) >= 2;
  }
  /// Ways out of the node that traffic may take.
  std::vector<Step> exits(std::int64_t node) const {
    std::vector<Step> result;
    if (const auto found = arms_.find(node); found != arms_.end())
      for (const Step& step : found->second)
        if (may_go(*step.way, step.direction)) result.push_back(step);
    return result;
  }
  /// First junction along the traffic, and how far it is; 0 where there is none within reach.
  /// `last` is the step onto it.
  std::int64_t junction_ahead(Step step, double reach, double& distance,
                              Step* last = nullptr) const {
    distance = 0;
    std::set<std::int64_t> seen;
    while (distance <= reach) {
      const std::size_t next = step.direction > 0 ? step.index + 1 : step.index - 1;
      const std::int64_t here = step.way->nodes[step.index], there = step.way->nodes[next];
      const GeoPoint a = map_.nodes.at(here).place, b = map_.nodes.at(there).place;
      distance += LocalMetric(a).distance(a, b);
      if (distance > reach || !seen.insert(there).second) return 0;
      if (last != nullptr) *last = step;
      if (is_junction(there)) return there;
      const std::optional<Step> on = straightest_exit(there, here);
      if (!on) return 0;
      step = *on;
    }
    return 0;
  }

  bool known(std::int64_t node) const { return arms_.contains(node); }
  std::size_t arm_count(std::int64_t node) const { return arms_.at(node).size(); }
  const std::vector<Step>& arms(std::int64_t node) const { return arms_.at(node); }
  /// True where a junction lies within reach along any arm, whatever the direction of traffic.
  bool junction_within(std::int64_t node, double reach) const {
    for (const Step& arm : arms_.at(node)) {
      double distance = 0;
      for (std::size_t i = arm.index;;) {
        if (arm.direction < 0 ? i == 0 : i + 1 == arm.way->nodes.size()) break;
        const std::size_t next = arm.direction > 0 ? i + 1 : i - 1;
        const GeoPoint a = map_.nodes.at(arm.way->nodes[i]).place,
                       b = map_.nodes.at(arm.way->nodes[next]).place;
        distance += LocalMetric(a).distance(a, b);
        if (distance > reach) break;
        if (arm_count(arm.way->nodes[next]) >= 3) return true;
        i = next;
      }
    }
    return false;
  }

 private:
  /// The way on from a node that is no junction: where a slip lane leaves, the one straight ahead.
  std::optional<Step> straightest_exit(std::int64_t node, std::int64_t came_from) const {
    std::optional<Step> best;
    double least = kPi / 4;
    const GeoPoint here = map_.nodes.at(node).place;
    const LocalMetric metric(here);
    const double before = metric.bearing(map_.nodes.at(came_from).place, here);
    for (const Step& exit : exits(node)) {
      const std::size_t after = exit.direction > 0 ? exit.index + 1 : exit.index - 1;
      const std::int64_t next = exit.way->nodes[after];
      if (next == came_from) continue;
      const double turn =
          std::abs(wrap_angle(metric.bearing(here, map_.nodes.at(next).place) - before));
      if (turn >= least) continue;
      least = turn;
      best = exit;
    }
    return best;
  }
  static bool may_go(const MapWay& way, int direction) {
    return !is_one_way(way) || (is_reversed(way) ? direction < 0 : direction > 0);
  }
  void add(const MapWay& way, std::size_t index, int direction) {
    arms_[way.nodes[index]].push_back({&way, index, direction});
    inputs_[way.nodes[index]] += may_go(way, -direction) ? 1 : 0;
  }
  const OsmMap& map_;
  std::map<std::int64_t, std::vector<Step>> arms_;
  std::map<std::int64_t, int> inputs_;
};

/// False where the signal or sign is known to be for the other direction of its way.
bool faces(const Tags& tags, int direction) {
  for (const char* key :
       {"traffic_signals:direction", "give_way:direction", "stop:direction", "direction"}) {
    if (tag_is(tags, key, {"forward"})) return direction > 0;
    if (tag_is(tags, key, {"backward"})) return direction < 0;
  }
  return true;
}

}  // namespace

void snap_signals(OsmMap& map, double reach, IssueLog& log) {
  const TrafficGraph graph(map);
  std::vector<std::pair<std::int64_t, std::int64_t>> moves;
  for (const auto& [id, node] : map.nodes) {
    if (!tag_is(node.tags, "highway", {"traffic_signals"})) continue;
    if (graph.is_junction(id)) continue;
    const std::string name = "node/" + std::to_string(id);
    const std::vector<Step> exits = graph.exits(id);
    if (exits.empty()) continue;
    if (tag_is(node.tags, "crossing", {"traffic_signals"})) {
      log.add(Severity::Note, "signal_at_crossing",
              "signalled crossings between junctions, kept in place", name);
      continue;
    }
    std::int64_t target = 0;
    double nearest = reach;
    for (const Step& exit : exits) {
      double distance = 0;
      if (!faces(node.tags, exit.direction)) continue;
      const std::int64_t junction = graph.junction_ahead(exit, reach, distance);
      if (junction != 0 && distance <= nearest) {
        target = junction;
        nearest = distance;
      }
    }
    if (target == 0)
      log.add(Severity::Note, "signal_without_junction",
              "signals with no junction ahead, kept in place", name);
    else
      moves.emplace_back(id, target);
  }
  for (const auto& [from, to] : moves) {
    map.nodes.at(from).tags.erase("highway");
    map.nodes.at(to).tags["highway"] = "traffic_signals";
    log.add(Severity::Note, "signal_moved",
            "signals on stop lines moved to the junction that they guard",
            "node/" + std::to_string(from));
  }
}

void add_footways_at_crossings(OsmMap& map, IssueLog& log) {
  constexpr double kNearJunction = 15.0,
                   kReach = 9.0;  // [m]; the footway reaches over half a road and its sidewalk
  const TrafficGraph graph(map);
  const Uses uses = count_node_uses(map);
  std::vector<MapWay> added;
  std::vector<std::int64_t> crossings;
  for (const auto& [id, node] : map.nodes) {
    const bool crossing =
        tag_is(node.tags, "highway", {"crossing"}) ||
        (tag_is(node.tags, "highway", {"traffic_signals"}) && node.tags.contains("crossing"));
    if (!crossing || tag_is(node.tags, "crossing", {"no"}) || !graph.known(id)) continue;
    // two arms that are all of its uses: in the middle of a road, and no footway there
    const auto& arms = graph.arms(id);
    if (arms.size() != 2 || uses.at(id) != (arms[0].way == arms[1].way ? 1 : 2)) continue;
    if (tag_is(arms[0].way->tags, "highway", {"motorway", "motorway_link", "service"})) continue;
    if (!graph.junction_within(id, kNearJunction)) crossings.push_back(id);
  }
  for (const std::int64_t id : crossings) {
    const auto& arms = graph.arms(id);
    const auto beside = [&](const Step& arm) {
      return map.nodes.at(arm.way->nodes[arm.direction > 0 ? arm.index + 1 : arm.index - 1]).place;
    };
    const GeoPoint here = map.nodes.at(id).place;
    const LocalMetric metric(here);
    const double along = metric.bearing(beside(arms[0]), beside(arms[1]));
    for (const double side : {kPi / 2, -kPi / 2}) {
      const std::int64_t end = map.new_id();
      map.nodes[end].place =
          metric.place(kReach * std::cos(along + side), kReach * std::sin(along + side));
      added.push_back({map.new_id(), {end, id}, {{"highway", "footway"}}});
    }
    log.add(Severity::Note, "crossing_kept",
            "crossings half way along a road, given footways so that SUMO builds them",
            "node/" + std::to_string(id));
  }
  map.ways.insert(map.ways.end(), added.begin(), added.end());
}

SignsByJunction find_signs(const OsmMap& map, const char* kind, double reach) {
  const TrafficGraph graph(map);
  SignsByJunction signs;
  for (const auto& [id, node] : map.nodes) {
    if (!tag_is(node.tags, "highway", {kind}) || !graph.known(id)) continue;
    std::int64_t target = 0;
    double nearest = reach;
    WayApproach approach;
    for (const Step& exit : graph.exits(id)) {
      double distance = 0;
      if (!faces(node.tags, exit.direction)) continue;
      Step last;
      const std::int64_t junction = graph.junction_ahead(exit, reach, distance, &last);
      if (junction == 0 || distance > nearest) continue;
      target = junction;
      nearest = distance;
      approach = {last.way->id, last.direction};
    }
    if (target != 0) signs[target].push_back(approach);
  }
  return signs;
}

void filter_restrictions(OsmMap& map, IssueLog& log) {
  std::map<std::int64_t, const MapWay*> ways;
  for (const MapWay& way : map.ways)
    if (way.tags.contains("highway")) ways[way.id] = &way;
  std::vector<MapRelation> kept;
  for (MapRelation& relation : map.relations) {
    int from = 0, to = 0, via = 0;
    bool whole = true;
    std::int64_t via_node = 0;
    for (const MapMember& member : relation.members) {
      from += member.role == "from";
      to += member.role == "to";
      via += member.role == "via";
      if (member.type == 'w') whole = whole && ways.contains(member.ref);
      if (member.type == 'n') via_node = member.ref;
    }
    for (const MapMember& member : relation.members)
      if (whole && via_node != 0 && member.type == 'w')
        whole = ways.at(member.ref)->nodes.front() == via_node ||
                ways.at(member.ref)->nodes.back() == via_node;
    if (whole && from == 1 && to == 1 && via == 1)
      kept.push_back(std::move(relation));
    else
      log.add(Severity::Note, "dropped_restriction",
              "turn restrictions with a member outside the map",
              "relation/" + std::to_string(relation.id));
  }
  map.relations = std::move(kept);
}

void prepare_map(OsmMap& map, const PrepareOptions& options, IssueLog& log) {
  select_ways(map, log);
  correct_tag_values(map, log);
  normalise_tags(map, log);
  rewrite_contraflow(map, options.left_hand, log);
  drop_doubled_roads(map, log);
  if (options.left_hand) reverse_turn_lanes(map, log);
  if (options.clip) {
    clip_ways(map, options.box.grown(options.clip_margin), log);
    split_carriageway_ends(map, options.box, log);
  }
  snap_signals(map, options.signal_reach, log);
  round_bends(map, log);
  add_footways_at_crossings(map, log);
  filter_restrictions(map, log);
}

}  // namespace sumogamma::osm
