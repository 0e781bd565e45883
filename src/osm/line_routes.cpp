#include "osm/line_routes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "base/units.h"
#include "geometry/polyline.h"

namespace sumogamma::osm {
namespace {

using Route = std::vector<EdgeId>;

const Polyline& middle_of(const RoadNetwork& road, EdgeId edge) {
  // the lane next to the middle of the road, where the map draws its line
  return road.lane(road.edge(edge).lanes.back()).centerline;
}

/// Edges that a bus can go on to, but not straight back.
std::vector<EdgeId> edges_behind(const RoadNetwork& road, EdgeId edge) {
  std::vector<EdgeId> next;
  for (const LaneId id : road.edge(edge).lanes) {
    if ((road.lane(id).allowed & vehicle_class::kBus) == 0) continue;
    for (const ConnectionId out : road.lane(id).outgoing) {
      const Lane& target = road.lane(road.connection(out).to);
      if ((target.allowed & vehicle_class::kBus) == 0) continue;
      if (are_opposite(road.edge(edge), road.edge(target.edge))) continue;
      if (std::find(next.begin(), next.end(), target.edge) == next.end())
        next.push_back(target.edge);
    }
  }
  return next;
}

/// The shortest way from one edge to another with no more than so many metres between them: what
/// comes behind the first, the last included. Empty where there is none.
Route way_between(const RoadNetwork& road, EdgeId from, EdgeId to, double most) {
  using Entry = std::pair<double, EdgeId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::map<EdgeId, std::pair<double, EdgeId>> reached;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const auto [so_far, edge] = open.top();
    open.pop();
    if (edge == to && so_far > 0.0) break;
    for (const EdgeId next : edges_behind(road, edge)) {
      const double length = next == to ? 1e-3 : road.lane(road.edge(next).lanes.front()).length;
      const double way = so_far + length;
      if (way > most) continue;
      const auto known = reached.find(next);
      if (known != reached.end() && known->second.first <= way) continue;
      reached.insert_or_assign(next, std::pair(way, edge));
      open.emplace(way, next);
    }
  }
  Route route;
  if (!reached.contains(to)) return route;
  for (EdgeId edge = to;;) {
    route.push_back(edge);
    edge = reached.at(edge).second;
    if (edge == from) break;
  }
  std::reverse(route.begin(), route.end());
  return route;
}

/// An edge that a way of a line became, in its direction, and between which metres of that.
struct EdgeOnWay {
  EdgeId edge = kNoEdge;
  double from = 0, to = 0;
};

/// How an edge lies on the line of a way: between which of its metres, and for which share of the
/// edge's length.
struct Overlap {
  double from = std::numeric_limits<double>::infinity(), to = 0;
  double share = 0;
};

Overlap overlap_with(const Polyline& edge, const Polyline& way, double most, double least_cosine) {
  const int samples = std::clamp(static_cast<int>(edge.length() / 5.0), 3, 60);
  Overlap overlap;
  int along_it = 0;
  for (int i = 0; i < samples; ++i) {
    const double at = edge.length() * (i + 0.5) / samples;
    const PolylinePosition place = way.project(edge.point_at(at));
    if (place.distance > most) continue;
    if (edge.direction_at(at).dot(way.direction_at(place.along)) < least_cosine) continue;
    overlap.from = std::min(overlap.from, place.along);
    overlap.to = std::max(overlap.to, place.along);
    ++along_it;
  }
  overlap.share = static_cast<double>(along_it) / samples;
  return overlap;
}

/// Finds the edges that a way of the map became.
class EdgesOfWays {
 public:
  explicit EdgesOfWays(const LineGround& ground) : ground_(ground) {
    const RoadNetwork& road = ground.road;
    for (std::size_t i = 0; i < road.edges.size(); ++i) {
      const Edge& edge = road.edges[i];
      if (edge.kind != LaneKind::Normal || !allows(road, edge, vehicle_class::kBus)) continue;
      const auto origins = ground.origins.find(edge.name);
      if (origins == ground.origins.end()) continue;
      for (const std::int64_t way : origins->second)
        if (way < ground.first_new_way)
          by_way_[way].push_back(static_cast<EdgeId>(i));
        else
          cut_off_.push_back(static_cast<EdgeId>(i));
    }
  }

  /// In the order in which the way passes them.
  std::vector<EdgeOnWay> on(std::int64_t way, const Polyline& line) const {
    constexpr double kMoved = 20.0, kOnIt = 8.0;  // how far repairs and lanes lie off a way [m]
    std::vector<EdgeOnWay> found;
    const auto take = [&](EdgeId edge, const Overlap& overlap, double least) {
      if (overlap.share > least) found.push_back({edge, overlap.from, overlap.to});
    };
    if (const auto known = by_way_.find(way); known != by_way_.end())
      for (const EdgeId edge : known->second)
        take(edge, overlap_with(middle_of(ground_.road, edge), line, kMoved, 0.5), 0.0);
    // pieces have lost the number of their way: they are told by lying on it
    for (const EdgeId edge : cut_off_)
      take(edge, overlap_with(middle_of(ground_.road, edge), line, kOnIt, 0.8), 0.5);
    std::stable_sort(found.begin(), found.end(), [](const EdgeOnWay& a, const EdgeOnWay& b) {
      return a.from + a.to < b.from + b.to;
    });
    return found;
  }

 private:
  const LineGround& ground_;
  std::map<std::int64_t, std::vector<EdgeId>> by_way_;
  std::vector<EdgeId> cut_off_;
};

Polyline on_plane(const LineGround& ground, const std::vector<GeoPoint>& places) {
  std::vector<Vec2> points;
  for (const GeoPoint place : places)
    points.emplace_back(ground.projection.to_plane(place) + ground.road.projection_offset);
  return Polyline(points);
}

/// An edge on a run of ways, and whether the line was out of the place since the one before.
struct EdgeOnRun {
  EdgeId edge = kNoEdge;
  bool came_back = false;
};

/// Is the line out of the place between two of its metres?
bool leaves(const LineGround& ground, const std::vector<GeoPoint>& places, const Polyline& line,
            double from, double to) {
  double along = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i > 0) {
      const LocalMetric metric(places[i - 1]);
      along += metric.distance(places[i - 1], places[i]);
    }
    if (along > from && along < std::min(to, line.length() + 1.0) &&
        !ground.place.contains(places[i]))
      return true;
  }
  return false;
}

std::vector<EdgeOnRun> edges_on_run(const LineGround& ground, const EdgesOfWays& edges,
                                    const std::vector<LineWay>& run) {
  std::vector<EdgeOnRun> found;
  bool outside = false;
  for (const LineWay& way : run) {
    const Polyline line = on_plane(ground, way.places);
    double at = 0;
    for (const EdgeOnWay& one : edges.on(way.way, line)) {
      outside = outside || leaves(ground, way.places, line, at, one.from);
      at = std::max(at, one.to);
      if (!found.empty() && found.back().edge == one.edge && !outside) continue;
      found.push_back({one.edge, outside});
      outside = false;
    }
    outside = outside || leaves(ground, way.places, line, at, line.length() + 1.0);
  }
  return found;
}

/// Puts edges in a row together to routes: gaps are closed, edges that nothing leads to are left
/// out where the line goes on behind them, and where it doesn't another route begins.
void join_edges(const LineGround& ground, const std::vector<EdgeOnRun>& row,
                std::vector<Route>& routes) {
  constexpr double kGap = 300.0;     // [m]
  constexpr std::size_t kLooks = 4;  // edges ahead
  Route route;
  const auto finish = [&] {
    if (!route.empty()) routes.push_back(std::move(route));
    route.clear();
  };
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i].came_back) finish();
    if (route.empty()) {
      route.push_back(row[i].edge);
      continue;
    }
    if (route.back() == row[i].edge) continue;
    Route way;
    std::size_t reached = i;
    for (std::size_t k = i; k < std::min(i + kLooks, row.size()) && way.empty(); ++k) {
      if (k > i && row[k].came_back) break;
      way = way_between(ground.road, route.back(), row[k].edge, kGap);
      reached = k;
    }
    if (way.empty()) {
      finish();
      route.push_back(row[i].edge);
      continue;
    }
    route.insert(route.end(), way.begin(), way.end());
    i = reached;
  }
  finish();
}

double turn_between(const RoadNetwork& road, EdgeId a, EdgeId b) {
  const Polyline &in = middle_of(road, a), &out = middle_of(road, b);
  const Vec2 before = in.direction_at(in.length()), after = out.direction_at(0);
  return std::abs(std::atan2(cross(before, after), before.dot(after)));
}

/// Routes over a set of edges that stand for both directions: from each edge that none of them
/// leads to, straight on where there is a choice.
std::vector<Route> routes_through(const RoadNetwork& road, const std::set<EdgeId>& edges) {
  std::map<EdgeId, std::vector<EdgeId>> next;
  std::set<EdgeId> entered;
  for (const EdgeId edge : edges)
    for (const EdgeId behind : edges_behind(road, edge))
      if (edges.contains(behind)) {
        next[edge].push_back(behind);
        entered.insert(behind);
      }
  std::vector<EdgeId> begins;
  for (const EdgeId edge : edges)
    if (!entered.contains(edge)) begins.push_back(edge);
  // rings have no begin
  begins.insert(begins.end(), edges.begin(), edges.end());

  std::vector<Route> routes;
  std::set<EdgeId> used;
  for (const EdgeId begin : begins) {
    if (used.contains(begin)) continue;
    Route route{begin};
    std::set<EdgeId> own{begin};
    for (;;) {
      std::vector<EdgeId> ways = next[route.back()];
      std::erase_if(ways, [&](EdgeId edge) { return own.contains(edge); });
      if (ways.empty()) break;
      const EdgeId last = route.back();
      route.push_back(*std::min_element(ways.begin(), ways.end(), [&](EdgeId a, EdgeId b) {
        return std::pair(turn_between(road, last, a), a) <
               std::pair(turn_between(road, last, b), b);
      }));
      own.insert(route.back());
    }
    used.insert(route.begin(), route.end());
    routes.push_back(std::move(route));
  }
  return routes;
}

}  // namespace

std::vector<std::vector<EdgeId>> line_routes(const LineGround& ground, const MapLine& line) {
  const EdgesOfWays edges(ground);
  std::vector<Route> routes;
  if (line.directed) {
    for (const std::vector<LineWay>& run : line.runs)
      join_edges(ground, edges_on_run(ground, edges, run), routes);
    return routes;
  }
  std::set<EdgeId> all;
  for (const std::vector<LineWay>& run : line.runs)
    for (const LineWay& way : run)
      for (const EdgeOnWay& one : edges.on(way.way, on_plane(ground, way.places)))
        all.insert(one.edge);
  return routes_through(ground.road, all);
}

}  // namespace sumogamma::osm
