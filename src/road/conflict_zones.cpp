#include "road/conflict_zones.h"

#include <algorithm>
#include <optional>

#include "road/path_pieces.h"
#include "road/smoothing.h"

namespace sumogamma {

Polyline link_geometry(const RoadNetwork& network, ConnectionId id) {
  const Connection& connection = network.connection(id);
  if (network.lane(connection.to).kind == LaneKind::Crossing)
    return network.lane(connection.to).centerline;
  std::vector<Vec2> points;
  LaneId lane = connection.via;
  for (int hops = 0; lane != kNoLane && hops < 8; ++hops) {
    const Polyline& line = network.lane(lane).centerline;
    append_span(line, 0.0, line.length(), points);
    LaneId next = kNoLane;
    for (const ConnectionId onward : network.lane(lane).outgoing)
      if (network.connection(onward).to == connection.to) {
        next = network.connection(onward).via;
        break;
      }
    lane = next;
  }
  return Polyline(points);
}

bool is_driven(const RoadNetwork& network, ConnectionId id) {
  const Connection& connection = network.connection(id);
  return connection.via != kNoLane && connection.junction != kNoJunction &&
         network.lane(connection.from).kind == LaneKind::Normal &&
         network.lane(connection.to).kind == LaneKind::Normal;
}

std::vector<ConnectionId> driven_links(const RoadNetwork& network, const Junction& junction) {
  std::vector<ConnectionId> links;
  for (const ConnectionId id : junction.links)
    if (id != kNoConnection && is_driven(network, id)) links.push_back(id);
  return links;
}

Path rounded_way(const RoadNetwork& network, ConnectionId id, double before, double after,
                 const Cornering& cornering) {
  return rounded_way(network, std::span(&id, 1), before, after, cornering);
}

Path rounded_way(const RoadNetwork& network, std::span<const ConnectionId> ids, double before,
                 double after, const Cornering& cornering) {
  Path path;
  std::vector<Vec2> points;
  const auto append = [&](const Polyline& line, double from, double to, LaneId lane) {
    PathStretch stretch;
    stretch.from = path.stretches.empty() ? 0.0 : path.stretches.back().to;
    append_span(line, from, to, points);
    stretch.to = Polyline(points).length();
    stretch.kerb = width_to_kerb(network, network.lane(lane));
    path.stretches.push_back(stretch);
  };
  const LaneId first = network.connection(ids.front()).from;
  const Polyline& from = network.lane(first).centerline;
  append(from, std::max(0.0, from.length() - before), from.length(), first);
  for (const ConnectionId id : ids) {
    const Connection& connection = network.connection(id);
    const Polyline inside = link_geometry(network, id);
    if (inside.empty()) return {};
    const double stop_line = path.stretches.back().to;
    append(inside, 0.0, inside.length(), connection.via);
    if (path.links.empty())
      path.links.push_back({id, stop_line, path.stretches.back().to, stop_line});
    const Polyline& to = network.lane(connection.to).centerline;
    append(to, 0.0, id == ids.back() ? std::min(after, to.length()) : to.length(), connection.to);
  }
  path.line = Polyline(points);
  round_corners(cornering, path);
  move_stop_lines(network, path);
  return path;
}

namespace {

struct LinkShape {
  ConnectionId link = kNoConnection;
  Polyline line;
  double half_width = 0;                            ///< of what drives there
  double half_narrow_width = 0;                     ///< of what is no wider than kWideBody
  double begin = 0;                                 ///< of the line, from the link's begin [m]
  std::vector<Vec2> samples;                        ///< every kStep
  Vec2 lower = Vec2::Zero(), upper = Vec2::Zero();  ///< corners of a box about them [m]
};
constexpr double kStep = 1.0;

/// How far before its begin a way over a link is looked at [m]: where others turn over the lane so
/// far before its end that the line is drawn behind them, who is beyond it is in their way.
double looked_before(const Connection& connection) {
  constexpr double kAtEnd = 10.0;  // of a lane, which bodies at the line reach over [m]
  return connection.setback > kAtEnd ? connection.setback : 0.0;
}

/// The way that is driven over a link by a car, or by a bicycle where only those may, from `before`
/// [m] before its stop line on.
Polyline driven_way(const RoadNetwork& network, ConnectionId id, double before) {
  constexpr double kBeyond = 20.0, kOfCars = 3.8, kOfBicycles = 1.15;  // [m]
  const double approach = kBeyond + before;
  const Connection& connection = network.connection(id);
  if (network.lane(connection.to).kind == LaneKind::Crossing) return link_geometry(network, id);
  const bool for_bicycles =
      connection.via != kNoLane && is_without_motors(network.lane(connection.via));
  const Path path =
      rounded_way(network, id, approach, kBeyond, {for_bicycles ? kOfBicycles : kOfCars});
  if (path.links.empty()) return {};
  std::vector<Vec2> driven;
  append_span(path.line, path.links.front().stop_line - before, path.links.front().end, driven);
  return Polyline(driven);
}

LinkShape shape_of(const RoadNetwork& network, ConnectionId id) {
  LinkShape shape;
  shape.link = id;
  const Connection& connection = network.connection(id);
  const double before = looked_before(connection);
  shape.line = driven_way(network, id, before);
  shape.begin = -before;
  const Lane& lane = network.lane(connection.via != kNoLane ? connection.via : connection.to);
  // what drives on a lane is narrower than the lane; a crossing is used over its whole width
  constexpr double kHalfBicycle = 0.33, kHalfBody = 1.35;  // [m]
  const double widest = is_without_motors(lane) ? kHalfBicycle : kHalfBody;
  const auto used = [&](double half_body) {
    return lane.kind == LaneKind::Crossing ? 0.5 * lane.width
                                           : std::min(0.5 * lane.width, half_body);
  };
  shape.half_width = used(widest);
  shape.half_narrow_width = used(std::min(widest, 0.5 * kWideBody));
  if (shape.line.empty()) return shape;
  const auto count = static_cast<int>(shape.line.length() / kStep) + 1;
  for (int k = 0; k <= count; ++k) shape.samples.push_back(shape.line.point_at(k * kStep));
  shape.lower = shape.upper = shape.samples.front();
  for (const Vec2& sample : shape.samples) {
    shape.lower = shape.lower.cwiseMin(sample);
    shape.upper = shape.upper.cwiseMax(sample);
  }
  return shape;
}

/// First and last place of `a` that lies within reach of `b`.
std::optional<std::pair<double, double>> near_span(const LinkShape& a, const LinkShape& b,
                                                   double reach) {
  std::optional<std::pair<double, double>> span;
  const Vec2 margin = Vec2::Constant(reach + 1e-6), lower = b.lower - margin,
             upper = b.upper + margin;
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    if ((a.samples[k].array() < lower.array()).any() ||
        (a.samples[k].array() > upper.array()).any())
      continue;
    const bool near = std::any_of(b.samples.begin(), b.samples.end(), [&](const Vec2& point) {
      return (point - a.samples[k]).squaredNorm() < reach * reach;
    });
    if (!near) continue;
    const double along = a.begin + std::min(static_cast<double>(k) * kStep, a.line.length());
    if (!span) span.emplace(along, along);
    span->second = along;
  }
  return span;
}

/// How near two ways must come to be in each other's way, for two bodies whose half widths are
/// `bodies` together [m]. Those that start side by side are not yet, though bodies that swing may
/// come near there: only from where they approach each other. Nor are one that starts beside the
/// end of the other where the one who has to wait may do so on the junction, as who turns across
/// those who come towards it, or where they are the two directions of one road that is narrow.
double conflict_reach(const RoadNetwork& network, const LinkShape& a, const LinkShape& b,
                      double bodies, bool waits_inside) {
  constexpr double kAir = 0.3, kNearer = 0.4, kLeast = 1.5;  // [m]
  const double roomy = bodies + kAir;
  double reach = roomy;
  const auto from_apart = [&](double apart) {
    reach = std::min(reach, std::max(apart - kNearer, std::min(bodies, kLeast)));
  };
  const auto edge_of = [&](LaneId lane) -> const Edge& {
    return network.edge(network.lane(lane).edge);
  };
  const Connection &own = network.connection(a.link), &other = network.connection(b.link);
  const Lane &from = network.lane(own.from), &beside = network.lane(other.from);
  if (from.edge == beside.edge && from.index != beside.index)
    from_apart((a.samples.front() - b.samples.front()).norm());
  const bool at_begin = are_opposite(edge_of(own.from), edge_of(other.to));
  const bool at_end = are_opposite(edge_of(own.to), edge_of(other.from));
  const auto beside_each_other = [&](double apart) {
    if (waits_inside || (at_begin && at_end && apart < roomy)) from_apart(apart);
  };
  if (at_begin) beside_each_other((a.samples.front() - b.samples.back()).norm());
  if (at_end) beside_each_other((a.samples.back() - b.samples.front()).norm());
  return reach;
}

/// Where two ways lie within reach of each other.
std::optional<SharedStretch> shared_stretch(const LinkShape& a, const LinkShape& b, double reach) {
  const auto own = near_span(a, b, reach), other = near_span(b, a, reach);
  if (!own || !other) return {};
  return SharedStretch{own->first, own->second, other->first, other->second};
}

/// True where two links start on the same edge, or both are crossings.
bool same_origin(const RoadNetwork& network, ConnectionId a, ConnectionId b) {
  const Connection &first = network.connection(a), &second = network.connection(b);
  const bool both_on_foot = network.lane(first.to).kind == LaneKind::Crossing &&
                            network.lane(second.to).kind == LaneKind::Crossing;
  return both_on_foot || network.lane(first.from).edge == network.lane(second.from).edge;
}

/// Does the link with request index `row` have to let another one pass?
bool gives_way(const Junction& junction, std::size_t row, std::size_t other) {
  return row < junction.requests.size() && other < junction.requests[row].yields_to.size() &&
         junction.requests[row].yields_to[other];
}

void add_conflicts(const RoadNetwork& network, const Junction& junction, ConflictTable& table) {
  std::vector<LinkShape> shapes(junction.links.size());
  for (std::size_t i = 0; i < shapes.size(); ++i)
    if (junction.links[i] != kNoConnection) shapes[i] = shape_of(network, junction.links[i]);

  for (std::size_t i = 0; i < junction.requests.size() && i < shapes.size(); ++i) {
    const RightOfWay& request = junction.requests[i];
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const bool yields = gives_way(junction, i, k);
      const bool conflicts = k < request.conflicts.size() && request.conflicts[k];
      if (i == k || shapes[i].samples.empty() || shapes[k].samples.empty()) continue;
      // ways that part from one lane are one behind the other before they part
      const bool ruled = yields || conflicts;
      if (!ruled && same_origin(network, junction.links[i], junction.links[k])) continue;
      const bool waits_inside = (yields && request.may_stop_inside) ||
                                (gives_way(junction, k, i) && junction.requests[k].may_stop_inside);
      const auto shared = [&](double bodies) {
        return shared_stretch(shapes[i], shapes[k],
                              conflict_reach(network, shapes[i], shapes[k], bodies, waits_inside));
      };
      const auto stretch = shared(shapes[i].half_width + shapes[k].half_width);
      if (!stretch) continue;
      const ConnectionId foe = junction.links[k];
      // who enters a roundabout looks for a gap that any body leaves: capacities of entries depend
      // on it
      const bool joins_ring = junction.in_roundabout && network.connection(junction.links[i]).to ==
                                                            network.connection(foe).to;
      const auto of_narrow =
          joins_ring ? stretch : shared(shapes[i].half_narrow_width + shapes[k].half_narrow_width);
      table[index_of(junction.links[i])].push_back(
          {*stretch, foe, yields, gives_way(junction, k, i), !ruled,
           network.lane(network.connection(foe).to).kind == LaneKind::Crossing, of_narrow});
    }
  }
}

}  // namespace

std::optional<ConflictZone> zone_for(const ConflictZone& zone, bool one_is_wide) {
  if (one_is_wide) return zone;
  if (!zone.of_narrow) return {};
  ConflictZone narrow = zone;
  static_cast<SharedStretch&>(narrow) = *zone.of_narrow;
  return narrow;
}

ConflictTable build_conflict_table(const RoadNetwork& network, Workers& workers) {
  ConflictTable table(network.connections.size());
  // every link belongs to one junction
  workers.for_each_range(network.junctions.size(),
                         [&](std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t i = begin; i < end; ++i)
                             add_conflicts(network, network.junctions[i], table);
                         });
  return table;
}

}  // namespace sumogamma
