#include "osm/repairs/round_bends.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "geometry/simplify.h"
#include "geometry/vec2.h"
#include "osm/repairs/added_nodes.h"
#include "osm/repairs/hairpins.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

/// How the roads or paths of a kind are rounded.
struct BendRule {
  bool (*holds_for)(const MapWay&);
  double radius;        ///< [m] least of its middle
  double from_roads;    ///< [m] along it from a junction with a road, which netconvert shapes
  double from_paths;    ///< [m] likewise from other ends of paths
  double least;         ///< [m] a move that is not worth new points
  bool hairpins;        ///< are opened to bulbs
  bool ends_at_others;  ///< keeps the nodes that it shares with ways of another kind
};

constexpr BendRule kRules[] = {{is_car_way, 15.0, 15.0, 15.0, 0.5, true, false},
                               {is_cycle_way, 5.0, 15.0, 5.0, 0.15, false, true}};
constexpr double kTighter = 0.9;       // of the radius, where a bend would move too far
constexpr double kFarthest = 4.0;      // [m] that a point moves; maps are off by as much
constexpr double kHairpin = 7.0;       // [m] radius of the bulb that a hairpin becomes
constexpr double kPointSpacing = 1.5;  // [m] of the points that move
constexpr double kStill = 0.0005;      // [m] of change in a round that is none
constexpr double kTolerance = 0.05;    // [m] by which the drawn line may be off the rounded one
constexpr int kRounds = 5000;

/// A road from one junction, end or roundabout to the next, over the ends of ways.
using Road = std::vector<std::int64_t>;

bool is_ring(const MapWay& way) {
  return tag_is(way.tags, "junction", {"roundabout", "circular"}) ||
         way.nodes.front() == way.nodes.back();
}

/// Roads of a kind but roundabouts, as nodes with those next to them; a road ends where it comes to
/// a ring, a cycleway where it comes to anything else that is travelled.
struct RoadGraph {
  std::map<std::int64_t, std::vector<std::int64_t>> neighbours;
  std::set<std::int64_t> ends;

  bool goes_on(std::int64_t node) const {
    const std::vector<std::int64_t>& next = neighbours.at(node);
    return next.size() == 2 && next[0] != next[1] && !ends.contains(node);
  }
};

RoadGraph make_graph(const OsmMap& map, const BendRule& rule) {
  RoadGraph graph;
  for (const MapWay& way : map.ways) {
    if (way.nodes.size() < 2) continue;
    const bool other = rule.ends_at_others && (is_car_way(way) || is_path_way(way));
    if (rule.holds_for(way) ? is_ring(way) : other)
      graph.ends.insert(way.nodes.begin(), way.nodes.end());
    if (!rule.holds_for(way) || is_ring(way)) continue;
    for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
      graph.neighbours[way.nodes[i]].push_back(way.nodes[i + 1]);
      graph.neighbours[way.nodes[i + 1]].push_back(way.nodes[i]);
    }
  }
  return graph;
}

std::vector<Road> find_roads(const OsmMap& map, const BendRule& rule) {
  const RoadGraph graph = make_graph(map, rule);
  std::vector<Road> roads;
  for (const auto& [end, nexts] : graph.neighbours) {
    if (graph.goes_on(end)) continue;
    for (const std::int64_t first : nexts) {
      Road road{end, first};
      while (graph.goes_on(road.back())) {
        const std::vector<std::int64_t>& next = graph.neighbours.at(road.back());
        road.push_back(next[0] == road[road.size() - 2] ? next[1] : next[0]);
      }
      // each is found from both of its ends
      if (std::pair(road.front(), road[1]) < std::pair(road.back(), road[road.size() - 2]))
        roads.push_back(std::move(road));
    }
  }
  return roads;
}

/// Nodes that roads lead over, or one-way roads alone.
std::set<std::int64_t> nodes_of_roads(const OsmMap& map, bool one_way_only) {
  std::set<std::int64_t> nodes;
  for (const MapWay& way : map.ways)
    if (is_car_way(way) && (!one_way_only || is_one_way(way)))
      nodes.insert(way.nodes.begin(), way.nodes.end());
  return nodes;
}

/// A road's line with points 1.5 m apart.
struct BendLine {
  std::vector<Vec2> points;         ///< [m]
  std::vector<std::size_t> places;  ///< by node of the road: which point it is
};

BendLine draw(const OsmMap& map, const LocalMetric& metric, const Road& road) {
  BendLine line;
  for (const std::int64_t node : road) {
    const GeoPoint place = map.nodes.at(node).place;
    const Vec2 here(metric.east(place), metric.north(place));
    if (!line.points.empty()) {
      const Vec2 before = line.points.back();
      const double pieces = std::max(1.0, std::round((here - before).norm() / kPointSpacing));
      for (double k = 1; k < pieces; ++k)
        line.points.push_back(before + (here - before) * (k / pieces));
    }
    line.places.push_back(line.points.size());
    line.points.push_back(here);
  }
  return line;
}

/// Where a point between two others has to be so that the three turn with no less than the radius.
Vec2 eased(const Vec2& before, const Vec2& point, const Vec2& after, double radius) {
  const double a = (point - before).norm(), b = (after - point).norm();
  if (a + b < 1e-6) return point;
  const Vec2 to_chord = (before * b + after * a) / (a + b) - point;
  const double off = to_chord.norm(), sagitta = a * b / (2 * radius);
  return off <= sagitta ? point : Vec2(point + to_chord * (1 - sagitta / off));
}

/// Eases a line, each point between its neighbours, until none moves any more. `radii` are by
/// point, 0 for those that stay.
std::vector<Vec2> ease(std::vector<Vec2> points, const std::vector<double>& radii) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (radii[i] > 0) free.push_back(i);
  for (int round = 0; round < kRounds; ++round) {
    double farthest = 0;
    for (const std::size_t i : free) {
      const Vec2 moved = eased(points[i - 1], points[i], points[i + 1], radii[i]);
      farthest = std::max(farthest, (moved - points[i]).norm());
      points[i] = moved;
    }
    if (farthest <= kStill) break;
    std::reverse(free.begin(), free.end());  // else bends lean to one side
  }
  return points;
}

/// A radius for the points of a line, none for those near its ends, which stay: so far from its
/// front and from its back [m].
std::vector<double> radii_along(const std::vector<Vec2>& points, double radius, double from_front,
                                double from_back) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < points.size(); ++i)
    along.push_back(along.back() + (points[i] - points[i - 1]).norm());
  std::vector<double> radii(points.size(), 0.0);
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    if (along[i] >= from_front && along.back() - along[i] >= from_back) radii[i] = radius;
  return radii;
}

/// The eased line: a bend that would move too far with a smaller radius, one that hardly moves not
/// at all. `radii` are by point, 0 for those that stay.
std::vector<Vec2> fitted(const std::vector<Vec2>& drawn, std::vector<double> radii, double least) {
  for (;;) {
    std::vector<Vec2> points = ease(drawn, radii);
    bool again = false;
    const auto moved = [&](std::size_t i) { return (points[i] - drawn[i]).norm(); };
    for (std::size_t first = 0, last = 0; first < points.size(); first = last + 1) {
      double farthest = 0;
      for (last = first; last < points.size() && moved(last) > 0; ++last)
        farthest = std::max(farthest, moved(last));
      if (farthest > 0 && farthest < least)
        std::copy_n(&drawn[first], last - first, &points[first]);
      again = again || farthest > kFarthest;
      if (farthest > kFarthest)
        for (std::size_t i = first; i < last; ++i) radii[i] *= kTighter;
    }
    if (!again) return points;
  }
}

void redraw(const Road& road, const BendLine& line, const LocalMetric& metric, OsmMap& map,
            AddedNodes& added) {
  const auto place_of = [&](const Vec2& p) { return metric.place(p.x(), p.y()); };
  for (std::size_t n = 0; n + 1 < road.size(); ++n) {
    if (n > 0) map.nodes.at(road[n]).place = place_of(line.points[line.places[n]]);
    const Vec2* points = line.points.data();
    const std::vector<Vec2> piece(points + line.places[n], points + line.places[n + 1] + 1);
    const std::vector<bool> needed = needed_points(piece, kTolerance);
    std::vector<std::int64_t>& nodes = added[{road[n], road[n + 1]}];
    for (std::size_t i = 1; i + 1 < piece.size(); ++i) {
      if (!needed[i]) continue;
      nodes.push_back(map.new_id());
      map.nodes[nodes.back()].place = place_of(piece[i]);
    }
  }
}

/// Rounds the roads of a kind: moves their nodes and tells which to add between them.
void round_roads(const BendRule& rule, OsmMap& map, AddedNodes& added, IssueLog& log) {
  const std::set<std::int64_t> on_roads = nodes_of_roads(map, false);
  const std::set<std::int64_t> one_way = nodes_of_roads(map, true);
  const auto from = [&](std::int64_t end) {
    return on_roads.contains(end) ? rule.from_roads : rule.from_paths;
  };
  for (const Road& road : find_roads(map, rule)) {
    const LocalMetric metric(map.nodes.at(road.front()).place);
    BendLine line = draw(map, metric, road);
    const std::vector<double> radii =
        radii_along(line.points, rule.radius, from(road.front()), from(road.back()));
    // where two one-way roads meet in a point they are an entry and an exit, and no hairpin
    const bool opened =
        rule.hairpins && std::none_of(road.begin() + 1, road.end() - 1,
                                      [&](std::int64_t node) { return one_way.contains(node); });
    const std::vector<Vec2> points = fitted(
        opened ? open_hairpins(line.points, radii, kHairpin) : line.points, radii, rule.least);
    if (points == line.points) continue;
    line.points = points;
    redraw(road, line, metric, map, added);
    log.add(Severity::Note, "bends_rounded",
            "roads and cycleways drawn with corners between junctions, where they were rounded",
            "node/" + std::to_string(road[road.size() / 2]));
  }
}

}  // namespace

void round_bends(OsmMap& map, IssueLog& log) {
  AddedNodes added;
  for (const BendRule& rule : kRules) round_roads(rule, map, added, log);
  insert_nodes(added, map);
}

}  // namespace sumogamma::osm
