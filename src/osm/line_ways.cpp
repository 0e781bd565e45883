#include "osm/line_ways.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

constexpr std::string_view kOnRoads[] = {"bus", "trolleybus", "share_taxi", "minibus"};
constexpr std::string_view kElsewhere[] = {"tram",      "light_rail", "subway",
                                           "train",     "railway",    "monorail",
                                           "funicular", "ferry",      "aerialway"};

bool starts_with_any(std::string_view role, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return role.starts_with(word); });
}

bool is_stop_role(const std::string& role) {
  return starts_with_any(role, {"stop", "platform", "forward:stop", "backward:stop", "hail"});
}

/// A way of a line and how it is taken: +1 along its nodes, -1 against them, 0: not known yet.
struct Taken {
  const MapWay* way = nullptr;
  int direction = 0;
};

bool is_closed(const MapWay& way) { return way.nodes.front() == way.nodes.back(); }

bool meets(const MapWay& way, std::int64_t node) {
  if (is_closed(way)) return std::find(way.nodes.begin(), way.nodes.end(), node) != way.nodes.end();
  return way.nodes.front() == node || way.nodes.back() == node;
}

std::int64_t last_node(const Taken& taken) {
  return taken.direction > 0 ? taken.way->nodes.back() : taken.way->nodes.front();
}

int direction_by_role(const std::string& role) {
  return role.starts_with("forward") ? 1 : role.starts_with("backward") ? -1 : 0;
}

/// The directions of the ways of one run: by roles, by where a way meets the next one or the one
/// before, by being one-way.
void orient(std::vector<Taken>& run) {
  for (std::size_t i = 0; i < run.size(); ++i) {
    Taken& taken = run[i];
    const MapWay& way = *taken.way;
    if (taken.direction != 0) continue;
    if (is_closed(way)) {
      taken.direction = is_reversed(way) ? -1 : 1;
      continue;
    }
    if (i + 1 < run.size()) {
      const bool ahead = meets(*run[i + 1].way, way.nodes.back()),
                 behind = meets(*run[i + 1].way, way.nodes.front());
      if (ahead != behind) taken.direction = ahead ? 1 : -1;
    }
    if (taken.direction == 0 && i > 0) {
      const MapWay& before = *run[i - 1].way;
      const bool from_front = is_closed(before) ? meets(before, way.nodes.front())
                                                : last_node(run[i - 1]) == way.nodes.front();
      const bool from_back = is_closed(before) ? meets(before, way.nodes.back())
                                               : last_node(run[i - 1]) == way.nodes.back();
      if (from_front != from_back) taken.direction = from_front ? 1 : -1;
    }
    if (taken.direction == 0 && is_one_way(way)) taken.direction = is_reversed(way) ? -1 : 1;
  }
}

std::vector<GeoPoint> places_of(const OsmMap& map, const std::vector<std::int64_t>& nodes,
                                int direction) {
  std::vector<GeoPoint> places;
  for (const std::int64_t node : nodes) places.push_back(map.nodes.at(node).place);
  if (direction < 0) std::reverse(places.begin(), places.end());
  return places;
}

/// The piece of a ring between the way before it and the one behind it; none where it doesn't lie
/// between two.
std::vector<std::int64_t> piece_of_ring(const std::vector<Taken>& run, std::size_t at) {
  if (at == 0 || at + 1 == run.size()) return {};
  std::vector<std::int64_t> ring = run[at].way->nodes;
  ring.pop_back();
  if (run[at].direction < 0) std::reverse(ring.begin(), ring.end());
  const auto node_of = [&](const MapWay& way) {
    return std::find_if(ring.begin(), ring.end(), [&](std::int64_t node) {
      return way.nodes.front() == node || way.nodes.back() == node;
    });
  };
  const auto entry = node_of(*run[at - 1].way), exit = node_of(*run[at + 1].way);
  if (entry == ring.end() || exit == ring.end() || entry == exit) return {};
  std::rotate(ring.begin(), entry, ring.end());
  const auto last = node_of(*run[at + 1].way);
  return {ring.begin(), last + 1};
}

/// Which of two stops of the relation comes first along a way whose direction nothing else tells.
int direction_by_stops(const OsmMap& map, const MapWay& way, const std::vector<LineStop>& stops) {
  constexpr double kFarthestRoad = 25.0;  // [m]
  const LocalMetric metric(map.nodes.at(way.nodes.front()).place);
  std::vector<double> at;
  for (const LineStop& stop : stops) {
    double nearest = kFarthestRoad, along = -1, so_far = 0;
    for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
      const GeoPoint a = map.nodes.at(way.nodes[i]).place, b = map.nodes.at(way.nodes[i + 1]).place;
      const double length = metric.distance(a, b);
      const double dx = metric.east(b) - metric.east(a), dy = metric.north(b) - metric.north(a);
      const double px = metric.east(stop.place) - metric.east(a),
                   py = metric.north(stop.place) - metric.north(a);
      const double share =
          length > 0 ? std::clamp((px * dx + py * dy) / (length * length), 0.0, 1.0) : 0.0;
      const double off = metric.distance(
          stop.place, {a.lon + share * (b.lon - a.lon), a.lat + share * (b.lat - a.lat)});
      if (off < nearest) {
        nearest = off;
        along = so_far + share * length;
      }
      so_far += length;
    }
    if (along >= 0) at.push_back(along);
  }
  if (at.size() < 2 || at.front() == at.back()) return 0;
  return at.front() < at.back() ? 1 : -1;
}

using WaysById = std::map<std::int64_t, const MapWay*>;

std::vector<std::vector<LineWay>> directed_runs(const OsmMap& map, const WaysById& ways,
                                                const MapRelation& relation,
                                                const std::vector<LineStop>& stops) {
  std::vector<std::vector<Taken>> taken(1);
  for (const MapMember& member : relation.members) {
    if (member.type != 'w' || is_stop_role(member.role)) continue;
    const auto way = ways.find(member.ref);
    if (way == ways.end()) {  // not in the extract: the line leaves it
      if (!taken.back().empty()) taken.emplace_back();
      continue;
    }
    taken.back().push_back({way->second, direction_by_role(member.role)});
  }
  std::vector<std::vector<LineWay>> runs;
  for (std::vector<Taken>& run : taken) {
    orient(run);
    std::vector<LineWay> line;
    for (std::size_t i = 0; i < run.size(); ++i) {
      Taken& one = run[i];
      if (one.direction == 0) one.direction = direction_by_stops(map, *one.way, stops);
      if (one.direction == 0) continue;
      const bool ring = is_closed(*one.way);
      const auto nodes = ring ? piece_of_ring(run, i) : one.way->nodes;
      if (nodes.size() < 2) continue;
      line.push_back({one.way->id, places_of(map, nodes, ring ? 1 : one.direction)});
    }
    if (!line.empty()) runs.push_back(std::move(line));
  }
  return runs;
}

std::vector<std::vector<LineWay>> ways_in_both_directions(const OsmMap& map, const WaysById& ways,
                                                          const MapRelation& relation) {
  std::vector<LineWay> all;
  std::set<std::pair<std::int64_t, int>> seen;
  for (const MapMember& member : relation.members) {
    const auto found = ways.find(member.ref);
    if (member.type != 'w' || is_stop_role(member.role) || found == ways.end()) continue;
    const MapWay& way = *found->second;
    int only = direction_by_role(member.role);
    if (only == 0 && is_one_way(way)) only = is_reversed(way) ? -1 : 1;
    for (const int direction : {1, -1})
      if ((only == 0 || only == direction) && seen.emplace(way.id, direction).second)
        all.push_back({way.id, places_of(map, way.nodes, direction)});
  }
  if (all.empty()) return {};
  return {std::move(all)};
}

std::string stop_id(char type, std::int64_t id) { return type + std::to_string(id); }

/// The stops among a relation's members that the extract holds; a place on the road is left out
/// where its platform is there as well.
std::vector<LineStop> stops_of(const OsmMap& map, const MapRelation& relation) {
  constexpr double kSame = 40.0;  // [m]
  std::vector<LineStop> platforms, stops;
  std::vector<bool> is_platform;
  for (const MapMember& member : relation.members) {
    const auto found = map.stops.find({member.type, member.ref});
    if (found == map.stops.end()) continue;
    if (member.type == 'w' && !is_stop_role(member.role)) continue;
    const Tags& tags = found->second.tags;
    const bool platform = member.type == 'w' || member.role.starts_with("platform") ||
                          tag_is(tags, "public_transport", {"platform"});
    stops.push_back({stop_id(member.type, member.ref), tag(tags, "name"), found->second.place});
    is_platform.push_back(platform);
    if (platform) platforms.push_back(stops.back());
  }
  std::vector<LineStop> kept;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const LocalMetric metric(stops[i].place);
    const bool doubled =
        !is_platform[i] &&
        std::any_of(platforms.begin(), platforms.end(), [&](const LineStop& platform) {
          return metric.distance(stops[i].place, platform.place) < kSame;
        });
    if (!doubled) kept.push_back(stops[i]);
  }
  return kept;
}

bool is_for_buses(const Tags& tags) {
  if (tag_is(tags, "highway", {"bus_stop"})) return true;
  if (!tag_is(tags, "public_transport", {"platform", "stop_position"})) return false;
  return tag_is(tags, "bus", {"yes", "designated"}) || tag_is(tags, "trolleybus", {"yes"}) ||
         tag_is(tags, "share_taxi", {"yes"});
}

std::string name_on_the_bus(const MapRelation& relation) {
  for (const char* key : {"ref", "name"})
    if (!tag(relation.tags, key).empty()) return tag(relation.tags, key);
  return std::to_string(relation.id);
}

/// One part of an interval in seconds; nothing where it is no time.
std::optional<double> seconds_of(std::string_view text) {
  double seconds = 0;
  int parts = 0;
  for (std::string_view rest = text; parts < 3; ++parts) {
    const std::size_t colon = rest.find(':');
    const std::string_view digits = rest.substr(0, colon);
    int value = 0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (code != std::errc() || end != digits.data() + digits.size() || value < 0 || value > 10000)
      return std::nullopt;
    seconds = 60 * seconds + value;
    if (colon == std::string_view::npos) break;
    rest = rest.substr(colon + 1);
  }
  if (parts > 2) return std::nullopt;
  return parts == 2 ? seconds : 60 * seconds;  // minutes, HH:MM, HH:MM:SS
}

}  // namespace

double headway_of(const std::string& interval) {
  const std::string_view text(interval);
  const std::size_t dash = text.find('-');
  const auto first = seconds_of(text.substr(0, dash));
  const auto second = dash == std::string_view::npos ? first : seconds_of(text.substr(dash + 1));
  if (!first || !second) return 0;
  return 0.5 * (*first + *second);
}

MapLines find_lines(const OsmMap& map) {
  MapLines found;
  WaysById ways;
  for (const MapWay& way : map.ways)
    if (way.tags.contains("highway")) ways[way.id] = &way;
  std::map<std::pair<std::string, std::string>, int> same_name;
  for (const MapRelation& relation : map.routes)
    ++same_name[{tag(relation.tags, "route"), name_on_the_bus(relation)}];

  for (const MapRelation& relation : map.routes) {
    const std::string& kind = tag(relation.tags, "route");
    if (std::find(std::begin(kElsewhere), std::end(kElsewhere), kind) != std::end(kElsewhere))
      ++found.others[kind];
    if (std::find(std::begin(kOnRoads), std::end(kOnRoads), kind) == std::end(kOnRoads)) continue;
    MapLine line{relation.id, name_on_the_bus(relation), kind, 0, false, {}, {}};
    line.headway = headway_of(tag(relation.tags, "interval"));
    line.directed = tag_is(relation.tags, "public_transport:version", {"2"}) ||
                    same_name[{kind, line.line}] > 1;
    line.stops = stops_of(map, relation);
    line.runs = line.directed ? directed_runs(map, ways, relation, line.stops)
                              : ways_in_both_directions(map, ways, relation);
    found.lines.push_back(std::move(line));
  }
  for (const auto& [key, stop] : map.stops)
    if (is_for_buses(stop.tags))
      found.stops.push_back({stop_id(key.first, key.second), tag(stop.tags, "name"), stop.place});
  return found;
}

}  // namespace sumogamma::osm
