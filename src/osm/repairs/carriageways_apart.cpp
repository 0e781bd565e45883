#include "osm/repairs/carriageways_apart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/box_grid.h"
#include "geometry/simplify.h"
#include "osm/lane_overlap.h"
#include "osm/repairs/bend_room.h"
#include "osm/repairs/road_bodies.h"

namespace sumogamma::osm {
namespace {

constexpr double kFarthest = 4.0;   // [m] sideways
constexpr double kSlope = 0.1;      // [m] sideways per metre along
constexpr double kStill = 0.005;    // [m] of change in a round that is none
constexpr double kStraight = 0.02;  // [m] by which a point may be off a straight line
constexpr double kLeast = 0.05;     // [m] a move that is not worth a new shape
constexpr double kGap = 0.25;  // [m] left between two that were moved apart; netconvert makes long
                               // junctions of lanes that touch
constexpr double kNarrow = 2.75;     // [m] width of a lane for driving where there is no room
constexpr double kInside = 1.0 / 3;  // share of a path's length
constexpr double kCell = 20.0;       // [m]
constexpr int kRounds = 12;

// ---------------------------------------------------------------------------- who overlaps whom

struct Segment {
  std::size_t body = 0, segment = 0;
};

/// Segments of all bodies, by the cells from which they can be met, wherever they and others move.
struct SegmentGrid {
  std::vector<Segment> segments;
  BoxGrid grid{kCell};

  explicit SegmentGrid(const std::vector<RoadBody>& bodies) {
    double widest = 0;
    for (const RoadBody& body : bodies) widest = std::max(widest, body.reach);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Vec2 reach = Vec2::Constant(bodies[b].reach + widest + 2 * kFarthest);
      const std::vector<Vec2>& points = bodies[b].points;
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        grid.add(static_cast<std::uint32_t>(segments.size()),
                 points[k].cwiseMin(points[k + 1]) - reach,
                 points[k].cwiseMax(points[k + 1]) + reach);
        segments.push_back({b, k});
      }
    }
  }
};

/// Where the perpendicular of one body's point meets another body.
struct Foot {
  std::size_t segment = 0;
  double share = 0;   ///< of the segment
  double offset = 0;  ///< [m] of the other line, to the left of the point's own
  double sign = 1;    ///< -1 where the lines run against each other
};

std::optional<Foot> foot_on(const RoadBody& body, std::size_t i, const RoadBody& other,
                            std::size_t segment) {
  const Vec2 here = body.moved(i), a = other.moved(segment);
  // most segments of a cell are too far off
  const double near = body.reach + other.reach + other.along[segment + 1] - other.along[segment] +
                      std::abs(other.shift[segment] - other.shift[segment + 1]);
  if ((here - a).squaredNorm() > near * near) return std::nullopt;
  const Vec2 b = other.moved(segment + 1);
  const Vec2 along = b - a, forward = -left_of(body.normals[i]);
  const double length = along.norm();
  if (length < 1e-6) return std::nullopt;
  const double cosine = forward.dot(along) / length;
  if (std::abs(cosine) < lane_overlap::kAlong) return std::nullopt;
  const double t = along.dot(here - a) / (length * length);
  const bool first = segment == 0, last = segment + 2 == other.points.size();
  // at a bend the feet of two segments leave a wedge open, but nothing lies beyond a body's ends
  if (t < (first ? 0.0 : -0.5) || t > (last ? 1.0 : 1.5)) return std::nullopt;
  const double share = std::clamp(t, 0.0, 1.0);
  const double height =
      other.heights[segment] + share * (other.heights[segment + 1] - other.heights[segment]);
  if (std::abs(height - body.heights[i]) > lane_overlap::kSameHeight) return std::nullopt;
  const Vec2 to_foot = a + share * along - here;
  const double side = body.normals[i].dot(to_foot);
  return Foot{segment, share, side < 0 ? -to_foot.norm() : to_foot.norm(), cosine < 0 ? -1.0 : 1.0};
}

/// What the point needs to be rid of the other body.
struct Clearance {
  std::size_t point = 0;
  Foot foot;
  double left = 0, right = 0;  ///< [m] to move the point's body to that side until all is clear
  double depth = 0;            ///< [m] by which lanes overlap now
};

std::optional<Clearance> clearance(const RoadBody& body, std::size_t i, const RoadBody& other,
                                   const Foot& foot) {
  const double at = other.along[foot.segment] +
                    foot.share * (other.along[foot.segment + 1] - other.along[foot.segment]);
  Clearance need{i, foot, 0, 0, 0};
  for (const BodyLane& mine : body.lanes) {
    if (body.along[i] < mine.from || body.along[i] > mine.to) continue;
    for (const BodyLane& theirs : other.lanes) {
      if (at < theirs.from || at > theirs.to || !must_be_apart(mine.use, theirs.use)) continue;
      const double center = foot.offset + foot.sign * theirs.offset,
                   reach = mine.half_width + theirs.half_width;
      need.left = std::max(need.left, center - mine.offset + reach);
      need.right = std::max(need.right, mine.offset - center + reach);
      need.depth = std::max(need.depth, reach - std::abs(mine.offset - center));
    }
  }
  if (need.depth <= 0) return std::nullopt;
  return need;
}

using Clearances = std::map<std::size_t, std::vector<Clearance>>;

/// By other body: the points of this one at which the two overlap.
Clearances find_clearances(const RoadNetwork& road, const std::vector<RoadBody>& bodies,
                           const SegmentGrid& grid, std::size_t b) {
  Clearances found;
  const RoadBody& body = bodies[b];
  for (std::size_t i = 0; i < body.points.size(); ++i) {
    if (body.along[i] < body.from || body.along[i] > body.to) continue;
    const std::vector<std::uint32_t>& near = grid.grid.at(body.points[i]);
    for (std::size_t k = 0; k < near.size();) {
      const std::size_t other = grid.segments[near[k]].body;
      std::optional<Foot> nearest;
      for (; k < near.size() && grid.segments[near[k]].body == other; ++k) {
        if (other == b) continue;
        const std::optional<Foot> foot =
            foot_on(body, i, bodies[other], grid.segments[near[k]].segment);
        if (foot && (!nearest || std::abs(foot->offset) < std::abs(nearest->offset)))
          nearest = foot;
      }
      if (!nearest || at_shared_junction(road.edge(body.edge), road.edge(bodies[other].edge),
                                         body.along[i] - body.from, body.to - body.along[i]))
        continue;
      if (const auto need = clearance(body, i, bodies[other], *nearest))
        found[other].push_back(*need);
    }
  }
  return found;
}

/// Runs of neighbouring points that are long and deep enough to matter: [first, last).
std::vector<std::pair<std::size_t, std::size_t>> runs_of(const RoadBody& body,
                                                         const std::vector<Clearance>& needs) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t first = 0; first < needs.size();) {
    std::size_t last = first + 1;
    double depth = needs[first].depth;
    for (; last < needs.size() && needs[last].point == needs[last - 1].point + 1; ++last)
      depth = std::max(depth, needs[last].depth);
    // half a step at either end is taken to overlap, too
    const std::size_t a = needs[first].point, z = needs[last - 1].point;
    const double from = a == 0 ? 0.0 : (body.along[a - 1] + body.along[a]) / 2,
                 to = z + 1 == body.along.size() ? body.along[z]
                                                 : (body.along[z] + body.along[z + 1]) / 2;
    if (to - from > lane_overlap::kShortest && depth > lane_overlap::kTolerance)
      runs.emplace_back(first, last);
    first = last;
  }
  return runs;
}

// ---------------------------------------------------------------------------- moving

/// Shares of a move for two bodies: equal, but what has no lane for driving makes way for what has.
std::pair<double, double> shares(const RoadBody& a, const RoadBody& b) {
  if (a.drives == b.drives) return {0.5, 0.5};
  return a.drives ? std::pair(0.0, 1.0) : std::pair(1.0, 0.0);
}

void keep_greater(std::vector<double>& moves, std::size_t i, double move) {
  if (std::abs(move) > std::abs(moves[i])) moves[i] = move;
}

/// Adds to `wanted` (by body and point) what one pair asks for.
void add_moves(const std::vector<RoadBody>& bodies, std::size_t a, std::size_t b,
               const std::vector<Clearance>& needs, std::vector<std::vector<double>>& wanted) {
  const auto [share_a, share_b] = shares(bodies[a], bodies[b]);
  std::vector<double> moves_a(bodies[a].points.size(), 0.0), moves_b(bodies[b].points.size(), 0.0);
  for (const auto& [first, last] : runs_of(bodies[a], needs)) {
    double left = 0, right = 0;
    for (std::size_t k = first; k < last; ++k) {
      left += needs[k].left;
      right += needs[k].right;
    }
    // one side for the whole run, whichever takes less
    const bool to_left = left < right;
    for (std::size_t k = first; k < last; ++k) {
      const Clearance& need = needs[k];
      const double move = to_left ? need.left + kGap : -need.right - kGap;
      keep_greater(moves_a, need.point, share_a * move);
      for (const std::size_t end : {need.foot.segment, need.foot.segment + 1})
        keep_greater(moves_b, end, -share_b * need.foot.sign * move);
    }
  }
  for (std::size_t i = 0; i < moves_a.size(); ++i) wanted[a][i] += moves_a[i];
  for (std::size_t i = 0; i < moves_b.size(); ++i) wanted[b][i] += moves_b[i];
}

/// Moves to the left [0] and to the right [1] by body and point [m], neither negative.
using Sides = std::array<std::vector<double>, 2>;

/// Carries moves over a link where they would otherwise fall off faster than kSlope; true where
/// something changed. A move to the left goes on as one to the right where lines run against each
/// other.
bool carry_over(const BodyLink& link, std::vector<Sides>& moves) {
  bool changed = false;
  const double drop = kSlope * link.distance;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    double& a = moves[link.body][side][link.point];
    double& b = moves[link.other][link.sign < 0 ? 1 - side : side][link.other_point];
    changed = changed || a < b - drop - 1e-9 || b < a - drop - 1e-9;
    a = std::max(a, b - drop);
    b = std::max(b, a - drop);
  }
  return changed;
}

/// Lets moves fade out at kSlope, along bodies and over links.
void fade(const std::vector<BodyLink>& links, std::vector<RoadBody>& bodies) {
  constexpr int kMostRounds = 20;  // a move of 4 m fades out within 40 m: few junctions
  std::vector<Sides> moves(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const double shift : bodies[b].shift) {
      moves[b][0].push_back(std::max(0.0, shift));
      moves[b][1].push_back(std::max(0.0, -shift));
    }
  bool changed = true;
  for (int round = 0; changed && round < kMostRounds; ++round) {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (std::vector<double>& side : moves[b]) fade_out(bodies[b].along, kSlope, side);
    changed = false;
    for (const BodyLink& link : links) changed = carry_over(link, moves) || changed;
  }
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (std::size_t i = 0; i < bodies[b].shift.size(); ++i)
      bodies[b].shift[i] = moves[b][0][i] - moves[b][1][i];
}

/// Rounds off the corners of the profile of moves, and holds it level within junctions, so that
/// lanes enter them straight.
void smooth(RoadBody& body) {
  const std::size_t n = body.shift.size();
  std::size_t first = 0, last = n - 1;
  while (first + 1 < n && body.along[first] < body.from) ++first;
  while (last > 0 && body.along[last] > body.to) --last;
  if (first > last) return;  // too short to hold a point
  const std::vector<double> before = body.shift;
  for (std::size_t i = first + 1; i < last; ++i)
    body.shift[i] = (before[i - 1] + 2 * before[i] + before[i + 1]) / 4;
  for (std::size_t i = 0; i < first; ++i) body.shift[i] = body.shift[first];
  for (std::size_t i = last + 1; i < n; ++i) body.shift[i] = body.shift[last];
}

/// Bodies that may meet the body, ascending.
std::vector<std::size_t> neighbours(const SegmentGrid& grid, const std::vector<RoadBody>& bodies,
                                    std::size_t b) {
  std::vector<std::size_t> found;
  for (const Vec2& point : bodies[b].points)
    for (const std::uint32_t index : grid.grid.at(point))
      if (const std::size_t other = grid.segments[index].body;
          found.empty() || found.back() != other)
        found.push_back(other);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Moves bodies until nothing overlaps or the rounds are over.
void move_apart(const RoadNetwork& road, const SegmentGrid& grid,
                const std::vector<BodyLink>& links, std::vector<RoadBody>& bodies) {
  std::vector<std::vector<std::size_t>> near;
  for (std::size_t b = 0; b < bodies.size(); ++b) near.push_back(neighbours(grid, bodies, b));
  std::vector<bool> moved(bodies.size(), true);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::vector<double>> wanted, before;
    for (const RoadBody& body : bodies) {
      wanted.emplace_back(body.shift.size(), 0.0);
      before.push_back(body.shift);
    }
    for (std::size_t a = 0; a < bodies.size(); ++a) {
      // where nothing moved nothing new is wanted, or it was wanted in vain
      if (std::none_of(near[a].begin(), near[a].end(), [&](std::size_t b) { return moved[b]; }))
        continue;
      for (const auto& [b, needs] : find_clearances(road, bodies, grid, a))
        if (a < b) add_moves(bodies, a, b, needs, wanted);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (std::size_t i = 0; i < wanted[b].size(); ++i)
        bodies[b].shift[i] = std::clamp(bodies[b].shift[i] + wanted[b][i], -kFarthest, kFarthest);
    fade(links, bodies);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      smooth(bodies[b]);
      moved[b] = false;
      for (std::size_t i = 0; i < before[b].size(); ++i)
        moved[b] = moved[b] || std::abs(bodies[b].shift[i] - before[b][i]) > kStill;
    }
    if (std::find(moved.begin(), moved.end(), true) == moved.end()) return;
  }
}

// ---------------------------------------------------------------------------- no room

/// Narrows the lanes for driving of bodies that still lie on others'; true where any was.
bool narrow(const RoadNetwork& road, const SegmentGrid& grid, std::vector<RoadBody>& bodies,
            CarriagewayPlan& plan) {
  std::set<std::size_t> crowded;
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (const auto& [b, needs] : find_clearances(road, bodies, grid, a))
      if (bodies[a].drives && bodies[b].drives && !runs_of(bodies[a], needs).empty())
        crowded.insert({a, b});
  bool any = false;
  for (const std::size_t b : crowded) {
    RoadBody& body = bodies[b];
    std::vector<double> old_widths;
    bool narrowed = false;
    for (BodyLane& lane : body.lanes) {
      old_widths.push_back(2 * lane.half_width);
      if (lane.use != LaneUse::Driving || 2 * lane.half_width <= kNarrow) continue;
      lane.half_width = kNarrow / 2;
      plan.lane_widths[road.lane(lane.lane).name] = kNarrow;
      narrowed = true;
    }
    if (!narrowed) continue;
    any = true;
    lay_lanes_again(road, body.edge, old_widths, body);
    if (body.twin != kNoEdge) lay_lanes_again(road, body.twin, old_widths, body);
  }
  return any;
}

/// Share of the body's length that lies on lanes for driving of others.
double share_inside(const RoadNetwork& road, const std::vector<RoadBody>& bodies,
                    const SegmentGrid& grid, std::size_t b) {
  const RoadBody& body = bodies[b];
  std::set<std::size_t> inside;
  for (const auto& [other, needs] : find_clearances(road, bodies, grid, b)) {
    if (!bodies[other].drives) continue;
    for (const auto& [first, last] : runs_of(body, needs))
      for (std::size_t k = first; k < last; ++k) inside.insert(needs[k].point);
  }
  const auto active = std::count_if(body.along.begin(), body.along.end(), [&](double along) {
    return along >= body.from && along <= body.to;
  });
  return active == 0 ? 0.0 : static_cast<double>(inside.size()) / static_cast<double>(active);
}

/// Junctions between which people can walk, as groups.
class WalkGroups {
 public:
  WalkGroups(const RoadNetwork& road, const std::vector<RoadBody>& bodies,
             const std::set<std::size_t>& without)
      : group_(road.junctions.size()), degree_(road.junctions.size(), 0) {
    std::iota(group_.begin(), group_.end(), std::size_t{0});
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Edge& edge = road.edge(bodies[b].edge);
      if (without.contains(b) || edge.from == kNoJunction || edge.to == kNoJunction) continue;
      const bool walkable =
          std::any_of(bodies[b].lanes.begin(), bodies[b].lanes.end(), [&](const BodyLane& lane) {
            return (road.lane(lane.lane).allowed & vehicle_class::kPedestrian) != 0;
          });
      if (!walkable) continue;
      group_[find(index_of(edge.from))] = find(index_of(edge.to));
      ++degree_[index_of(edge.from)];
      ++degree_[index_of(edge.to)];
    }
  }
  /// True where the edge's ends are joined without it, or nothing else starts at one of them.
  bool spare(const Edge& edge) {
    const std::size_t from = index_of(edge.from), to = index_of(edge.to);
    return degree_[from] == 0 || degree_[to] == 0 || find(from) == find(to);
  }

 private:
  std::size_t find(std::size_t i) {
    while (group_[i] != i) i = group_[i] = group_[group_[i]];
    return i;
  }
  std::vector<std::size_t> group_;
  std::vector<int> degree_;
};

/// Drops the candidates that still lie on a carriageway, one after another, as long as nobody on
/// foot is cut off.
void drop_paths(const RoadNetwork& road, const SegmentGrid& grid,
                const std::vector<std::size_t>& candidates, std::vector<RoadBody>& bodies,
                CarriagewayPlan& plan) {
  std::set<std::size_t> dropped;
  for (const std::size_t b : candidates) {
    const Edge& edge = road.edge(bodies[b].edge);
    if (edge.from == kNoJunction || edge.to == kNoJunction ||
        share_inside(road, bodies, grid, b) <= 0)
      continue;
    dropped.insert(b);
    if (!WalkGroups(road, bodies, dropped).spare(edge)) {
      dropped.erase(b);
      continue;
    }
    plan.dropped.insert(edge.name);
    if (bodies[b].twin != kNoEdge) plan.dropped.insert(road.edge(bodies[b].twin).name);
  }
  for (const std::size_t b : dropped) bodies[b].lanes.clear();  // in nobody's way
}

// ---------------------------------------------------------------------------- result

using Point3 = Eigen::Vector3d;

/// SUMO's shape attribute of the moved line; points that a bend's inside folded over, and those
/// that a straight line does not need, are left out. `aside` is by how much more an edge moves than
/// its body, to the left of the body's line [m].
std::string shape_text(const RoadBody& body, const std::vector<double>& aside, bool reversed) {
  std::vector<Point3> points;
  std::size_t kept = 0;
  const auto moved = [&](std::size_t i) {
    return Vec2(body.moved(i) + aside[i] * body.normals[i]);
  };
  for (std::size_t i = 0; i < body.points.size(); ++i) {
    const bool last = i + 1 == body.points.size();
    const Vec2 p = moved(i);
    if (i > 0 && !last && (p - moved(kept)).dot(body.points[i] - body.points[kept]) <= 0) continue;
    points.emplace_back(p.x(), p.y(), body.heights[i]);
    kept = i;
  }
  std::vector<bool> needed = needed_points(points, kStraight);
  if (reversed) {
    std::reverse(points.begin(), points.end());
    std::reverse(needed.begin(), needed.end());
  }
  std::string text;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!needed[i]) continue;
    char word[96];
    std::snprintf(word, sizeof word, "%.2f,%.2f,%.2f", points[i].x(), points[i].y(), points[i].z());
    text += (text.empty() ? "" : " ") + std::string(word);
  }
  return text;
}

double greatest(const std::vector<double>& moves) {
  double most = 0;
  for (const double move : moves) most = std::max(most, std::abs(move));
  return most;
}

}  // namespace

CarriagewayPlan plan_carriageways(const NetworkFile& network) {
  const RoadNetwork& road = network.road;
  CarriagewayPlan plan;
  std::vector<RoadBody> bodies = make_road_bodies(network);
  const std::vector<BodyLink> links = make_body_links(road, bodies);
  const SegmentGrid grid(bodies);
  std::vector<std::size_t> paths_inside;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!bodies[b].drives && share_inside(road, bodies, grid, b) > kInside)
      paths_inside.push_back(b);

  move_apart(road, grid, links, bodies);
  drop_paths(road, grid, paths_inside, bodies, plan);
  if (narrow(road, grid, bodies, plan)) move_apart(road, grid, links, bodies);

  for (const RoadBody& body : bodies) {
    if (plan.dropped.contains(road.edge(body.edge).name)) continue;
    const BendRoom room = room_in_bends(body, road.left_hand);
    const double farthest = greatest(body.shift);
    if (std::max({farthest, greatest(room.edge), greatest(room.twin)}) < kLeast) continue;
    const bool apart = farthest >= kLeast;
    if (apart) plan.farthest = std::max(plan.farthest, farthest);
    const auto reshape = [&](EdgeId id, const std::vector<double>& aside, bool reversed) {
      const std::string& name = road.edge(id).name;
      plan.shapes[name] = shape_text(body, aside, reversed);
      if (apart) plan.apart.insert(name);
      if (greatest(aside) >= kLeast) plan.bends.insert(name);
    };
    reshape(body.edge, room.edge, false);
    if (body.twin != kNoEdge) reshape(body.twin, room.twin, true);
  }
  return plan;
}

}  // namespace sumogamma::osm
