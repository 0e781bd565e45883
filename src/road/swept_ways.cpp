#include "road/swept_ways.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/oriented_box.h"

namespace sumogamma {

namespace {

// the longest body that turns anywhere [m]
constexpr double kBusLength = 12.0, kBusWidth = 2.5, kBusAxle = 2.7, kBusRadius = 6.6;
// of who is in the way, and some: bodies come out of a bend up to 0.3 m beside what is reckoned [m]
constexpr double kHalfWidth = 1.45, kHalfWidthOfWide = 1.6;
constexpr double kPace = 0.5;       ///< [m]
constexpr double kFarthest = 16.0;  ///< before a lane's end that anybody halts for a bus [m]

/// What a bus sweeps on its way over a link: its body at each half metre while it is askew. Its
/// middle follows the way, its rear axle lies kBusAxle behind.
struct Sweep {
  std::vector<OrientedBox> bodies;
  double first = 0;  ///< place of the first one's middle, from the link's stop line [m]
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();  ///< their bounds [m]
};

Sweep sweep_of_bus(const RoadNetwork& network, ConnectionId id) {
  constexpr double kTurns = 0.12;  // [rad]
  constexpr double kAskew = 0.04;  // sine of its angle to its way
  const Connection& connection = network.connection(id);
  Sweep sweep;
  if ((network.lane(connection.to).allowed & vehicle_class::kBus) == 0) return sweep;
  const Polyline& before = network.lane(connection.from).centerline;
  const Vec2 leaves = network.lane(connection.to).centerline.direction_at(0.0);
  if (before.direction_at(before.length()).dot(leaves) > std::cos(kTurns)) return sweep;
  const Path path = rounded_way(network, id, kBusLength, 2.0 * kBusLength,
                                {kBusRadius, kBusLength, kBusWidth, network.left_hand});
  if (path.links.empty()) return sweep;
  double heading = heading_of(path.line.direction_at(0.0));
  sweep.low = Vec2::Constant(std::numeric_limits<double>::infinity());
  sweep.high = -sweep.low;
  std::size_t straight = 0;  // bodies since it was last askew
  for (double along = 0.0; along <= path.line.length(); along += kPace) {
    const Vec2 forward = direction_of(heading), place = path.line.point_at(along);
    const double swing = cross(forward, path.line.direction_at(along));
    heading += kPace * swing / kBusAxle;
    const bool askew = std::abs(swing) > kAskew;
    if (!askew && sweep.bodies.empty()) continue;
    if (sweep.bodies.empty()) sweep.first = along - path.links.front().stop_line;
    sweep.bodies.push_back({place, forward, {0.5 * kBusLength, 0.5 * kBusWidth}});
    straight = askew ? 0 : straight + 1;
  }
  sweep.bodies.resize(sweep.bodies.size() - straight);
  for (const OrientedBox& body : sweep.bodies) {
    sweep.low = sweep.low.cwiseMin(body.center);
    sweep.high = sweep.high.cwiseMax(body.center);
  }
  const Vec2 reach = Vec2::Constant(0.5 * kBusLength + 2.0 * kHalfWidthOfWide);
  sweep.low -= reach;
  sweep.high += reach;
  return sweep;
}

/// Where `sweep` meets the way of others of a width, from `kFarthest` and some before its stop line
/// to `end` behind it; foe_begin and foe_end are the sweeping body's, front and rear.
std::optional<SweptWay> swept_part(const Sweep& sweep, const Path& way, double end,
                                   double half_width) {
  const double stop_line = way.links.front().stop_line;
  std::optional<SweptWay> part;
  double first = 0.0, last = 0.0;  // middles of the bodies that touch
  for (double along = 0.0; along <= stop_line + end; along += kPace) {
    const Vec2 place = way.line.point_at(along);
    if ((place.array() < sweep.low.array()).any() || (place.array() > sweep.high.array()).any())
      continue;
    const OrientedBox slice{place, way.line.direction_at(along), {0.5 * kPace, half_width}};
    for (std::size_t k = 0; k < sweep.bodies.size(); ++k) {
      const OrientedBox& body = sweep.bodies[k];
      if ((body.center - place).norm() > kBusLength || separation(slice, body) > 0.0) continue;
      const double middle = sweep.first + static_cast<double>(k) * kPace;
      first = part ? std::min(first, middle) : middle;
      last = part ? std::max(last, middle) : middle;
      if (!part) part.emplace().begin = along - stop_line;
      part->end = along - stop_line;
    }
  }
  if (!part) return part;
  part->foe_begin = first + 0.5 * kBusLength;
  part->foe_end = last - 0.5 * kBusLength;
  return part;
}

}  // namespace

SweptWayTable find_swept_ways(const RoadNetwork& network, const ConflictTable& conflicts) {
  constexpr double kLooked = kFarthest + 2.0;  // [m]
  constexpr double kCarRadius = 3.8;           // [m]
  SweptWayTable table(network.connections.size());
  for (const Junction& junction : network.junctions) {
    std::vector<ConnectionId> links;
    for (const ConnectionId id : junction.links)
      if (id != kNoConnection && is_driven(network, id)) links.push_back(id);
    std::vector<Path> ways;
    for (const ConnectionId id : links)
      ways.push_back(rounded_way(network, id, kLooked, kLooked, {kCarRadius}));
    for (const ConnectionId id : links) {
      const Sweep sweep = sweep_of_bus(network, id);
      const EdgeId edge = network.lane(network.connection(id).from).edge;
      for (std::size_t k = 0; k < links.size() && !sweep.bodies.empty(); ++k) {
        if (network.lane(network.connection(links[k]).from).edge == edge || ways[k].links.empty())
          continue;
        const auto& zones = conflicts[index_of(links[k])];
        const bool ruled = std::any_of(zones.begin(), zones.end(),
                                       [&](const ConflictZone& zone) { return zone.foe == id; });
        const PathLink& link = ways[k].links.front();
        for (const bool wide : {false, true}) {
          auto part = swept_part(sweep, ways[k], ruled ? 0.0 : link.end - link.stop_line,
                                 wide ? kHalfWidthOfWide : kHalfWidth);
          if (!part || part->begin < -kFarthest) continue;
          part->foe = id;
          part->foe_is_long = true;
          part->for_wide = wide;
          table[index_of(links[k])].push_back(*part);
          table[index_of(id)].push_back(
              {links[k], part->foe_begin, part->foe_end, part->begin, part->end, false, wide});
        }
      }
    }
  }
  return table;
}

}  // namespace sumogamma
