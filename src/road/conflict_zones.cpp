#include "road/conflict_zones.h"

#include <algorithm>
#include <optional>

#include "road/path_profile.h"

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
  return Polyline(std::move(points));
}

namespace {

struct LinkShape {
  Polyline line;
  double half_width = 0;
  std::vector<Vec2> samples;  ///< every kStep
};
constexpr double kStep = 1.0;

/// The way that is driven over a link, with corners rounded as a car's path has them, from its stop
/// line on.
Polyline driven_way(const RoadNetwork& network, ConnectionId id) {
  constexpr double kApproach = 20.0, kTurningRadius = 3.8;
  const Connection& connection = network.connection(id);
  const Polyline inside = link_geometry(network, id);
  if (inside.empty() || network.lane(connection.to).kind == LaneKind::Crossing) return inside;
  const Polyline& before = network.lane(connection.from).centerline;
  const Polyline& after = network.lane(connection.to).centerline;
  std::vector<Vec2> points;
  append_span(before, std::max(0.0, before.length() - kApproach), before.length(), points);
  Path path;
  path.line = Polyline(points);
  const double stop_line = path.line.length();
  append_span(inside, 0.0, inside.length(), points);
  const double end = Polyline(points).length();
  append_span(after, 0.0, std::min(kApproach, after.length()), points);
  path.line = Polyline(std::move(points));
  path.links.push_back({id, stop_line, end, stop_line});
  round_corners(kTurningRadius, path);
  move_stop_lines(network, path);
  std::vector<Vec2> driven;
  append_span(path.line, path.links.front().stop_line, path.links.front().end, driven);
  return Polyline(std::move(driven));
}

LinkShape shape_of(const RoadNetwork& network, ConnectionId id) {
  LinkShape shape;
  shape.line = driven_way(network, id);
  const Connection& connection = network.connection(id);
  const Lane& lane = network.lane(connection.via != kNoLane ? connection.via : connection.to);
  // what drives on a lane is narrower than the lane; a crossing is used over its whole width
  shape.half_width =
      lane.kind == LaneKind::Crossing ? 0.5 * lane.width : std::min(0.5 * lane.width, 1.35);
  if (shape.line.empty()) return shape;
  const auto count = static_cast<int>(shape.line.length() / kStep) + 1;
  for (int k = 0; k <= count; ++k) shape.samples.push_back(shape.line.point_at(k * kStep));
  return shape;
}

/// First and last place of `a` that lies within reach of `b`.
std::optional<std::pair<double, double>> near_span(const LinkShape& a, const LinkShape& b,
                                                   double reach) {
  std::optional<std::pair<double, double>> span;
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    const bool near = std::any_of(b.samples.begin(), b.samples.end(), [&](const Vec2& point) {
      return (point - a.samples[k]).squaredNorm() < reach * reach;
    });
    if (!near) continue;
    const double along = std::min(static_cast<double>(k) * kStep, a.line.length());
    if (!span) span.emplace(along, along);
    span->second = along;
  }
  return span;
}

/// True where two links start on the same edge, or both are crossings.
bool same_origin(const RoadNetwork& network, ConnectionId a, ConnectionId b) {
  const Connection &first = network.connection(a), &second = network.connection(b);
  const bool both_on_foot = network.lane(first.to).kind == LaneKind::Crossing &&
                            network.lane(second.to).kind == LaneKind::Crossing;
  return both_on_foot || network.lane(first.from).edge == network.lane(second.from).edge;
}

void add_conflicts(const RoadNetwork& network, const Junction& junction, ConflictTable& table) {
  std::vector<LinkShape> shapes(junction.links.size());
  for (std::size_t i = 0; i < shapes.size(); ++i)
    if (junction.links[i] != kNoConnection) shapes[i] = shape_of(network, junction.links[i]);

  for (std::size_t i = 0; i < junction.requests.size() && i < shapes.size(); ++i) {
    const RightOfWay& request = junction.requests[i];
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const bool yields = k < request.yields_to.size() && request.yields_to[k];
      const bool conflicts = k < request.conflicts.size() && request.conflicts[k];
      if (i == k || shapes[i].samples.empty() || shapes[k].samples.empty()) continue;
      // ways that part from one lane are one behind the other before they part
      const bool ruled = yields || conflicts;
      if (!ruled && same_origin(network, junction.links[i], junction.links[k])) continue;
      const double reach = shapes[i].half_width + shapes[k].half_width + 0.3;
      const auto own = near_span(shapes[i], shapes[k], reach);
      const auto other = near_span(shapes[k], shapes[i], reach);
      if (!own || !other) continue;
      ConflictZone zone;
      zone.foe = junction.links[k];
      zone.begin = own->first;
      zone.end = own->second;
      zone.foe_begin = other->first;
      zone.foe_end = other->second;
      zone.yields = yields;
      zone.unruled = !ruled;
      zone.foe_is_crossing =
          network.lane(network.connection(zone.foe).to).kind == LaneKind::Crossing;
      table[index_of(junction.links[i])].push_back(zone);
    }
  }
}

}  // namespace

ConflictTable build_conflict_table(const RoadNetwork& network) {
  ConflictTable table(network.connections.size());
  for (const Junction& junction : network.junctions) add_conflicts(network, junction, table);
  return table;
}

}  // namespace sumogamma
