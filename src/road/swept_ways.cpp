#include "road/swept_ways.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/oriented_box.h"

namespace sumogamma {

namespace {

/// The largest of the bodies that turn alike [m].
struct Sweeper {
  TurningBody body;
  VehicleClassMask vehicle_class;
  double length, width;
  double axle;                            ///< the rear one, behind the middle
  double radius;                          ///< of its tightest turn
  double half_width, half_width_of_wide;  ///< of who is in its way, and some
};
// buses come out of a bend up to 0.3 m beside what is reckoned
constexpr Sweeper kSweepers[] = {
    {TurningBody::Truck, vehicle_class::kTruck, 7.5, 2.4, 1.8, 4.4, 1.15, 1.3},
    {TurningBody::Bus, vehicle_class::kBus, 12.0, 2.5, 2.7, 6.6, 1.45, 1.6}};
constexpr double kPace = 0.5;           ///< [m]
constexpr double kFarthestHalt = 20.0;  ///< before a lane's end that anybody halts for them [m]

/// What a body sweeps on its way over a link: its box at each half metre while it is askew. Its
/// middle follows the way.
struct Sweep {
  std::vector<OrientedBox> bodies;
  double first = 0;  ///< place of the first one's middle, from the link's stop line [m]
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();  ///< their bounds [m]
};

Sweep sweep_of(const Sweeper& sweeper, const RoadNetwork& network, ConnectionId id) {
  constexpr double kTurns = 0.12;  // [rad]
  constexpr double kAskew = 0.04;  // sine of its angle to its way
  const Connection& connection = network.connection(id);
  Sweep sweep;
  if ((network.lane(connection.to).allowed & sweeper.vehicle_class) == 0) return sweep;
  const Polyline& before = network.lane(connection.from).centerline;
  const Vec2 leaves = network.lane(connection.to).centerline.direction_at(0.0);
  if (before.direction_at(before.length()).dot(leaves) > std::cos(kTurns)) return sweep;
  const Path path = rounded_way(network, id, sweeper.length, 2.0 * sweeper.length,
                                {sweeper.radius, sweeper.length, sweeper.width, network.left_hand});
  if (path.links.empty()) return sweep;
  double heading = heading_of(path.line.direction_at(0.0));
  sweep.low = Vec2::Constant(std::numeric_limits<double>::infinity());
  sweep.high = -sweep.low;
  std::size_t straight = 0;  // bodies since it was last askew
  for (double along = 0.0; along <= path.line.length(); along += kPace) {
    const Vec2 forward = direction_of(heading), place = path.line.point_at(along);
    const double swing = cross(forward, path.line.direction_at(along));
    heading += kPace * swing / sweeper.axle;
    const bool askew = std::abs(swing) > kAskew;
    if (!askew && sweep.bodies.empty()) continue;
    if (sweep.bodies.empty()) sweep.first = along - path.links.front().stop_line;
    sweep.bodies.push_back({place, forward, {0.5 * sweeper.length, 0.5 * sweeper.width}});
    straight = askew ? 0 : straight + 1;
  }
  sweep.bodies.resize(sweep.bodies.size() - straight);
  for (const OrientedBox& body : sweep.bodies) {
    sweep.low = sweep.low.cwiseMin(body.center);
    sweep.high = sweep.high.cwiseMax(body.center);
  }
  const Vec2 reach = Vec2::Constant(0.5 * sweeper.length + 2.0 * sweeper.half_width_of_wide);
  sweep.low -= reach;
  sweep.high += reach;
  return sweep;
}

/// The way of a car over a link, and where it is at each half metre as far as the link's end.
struct WayOfCar {
  Path path;
  struct Place {
    Vec2 middle, direction;
  };
  std::vector<Place> places;
};

std::optional<WayOfCar> way_of_car(const RoadNetwork& network, ConnectionId id) {
  constexpr double kLooked = kFarthestHalt + 2.0;  // [m]
  constexpr double kCarRadius = 3.8;               // [m]
  WayOfCar way{rounded_way(network, id, kLooked, kLooked, {kCarRadius}), {}};
  if (way.path.links.empty()) return std::nullopt;
  const PathLink& link = way.path.links.front();
  const Polyline& line = way.path.line;
  const double end = std::max(link.stop_line, link.stop_line + (link.end - link.stop_line));
  for (double along = 0.0; along <= end; along += kPace)
    way.places.push_back({line.point_at(along), line.direction_at(along)});
  return way;
}

/// Where `sweep` meets the way of others of a width, from `kFarthestHalt` and some before its stop
/// line to `end` behind it; foe_begin and foe_end are the sweeping body's, front and rear.
std::optional<SweptWay> swept_part(const Sweep& sweep, double length, const WayOfCar& way,
                                   double end, double half_width) {
  const double stop_line = way.path.links.front().stop_line;
  std::optional<SweptWay> part;
  double first = 0.0, last = 0.0;  // middles of the bodies that touch
  for (std::size_t i = 0; i < way.places.size(); ++i) {
    const double along = static_cast<double>(i) * kPace;
    if (along > stop_line + end) break;
    const auto& [place, direction] = way.places[i];
    if ((place.array() < sweep.low.array()).any() || (place.array() > sweep.high.array()).any())
      continue;
    const OrientedBox slice{place, direction, {0.5 * kPace, half_width}};
    const double reach = slice.half.norm() + 1e-6;
    for (std::size_t k = 0; k < sweep.bodies.size(); ++k) {
      const OrientedBox& body = sweep.bodies[k];
      // seen from the body, is the slice off it by more than it reaches to any side?
      const Vec2 seen = to_body(place - body.center, body.forward);
      if (((seen.cwiseAbs() - body.half).array() > reach).any()) continue;
      if ((body.center - place).norm() > length || separation(slice, body) > 0.0) continue;
      const double middle = sweep.first + static_cast<double>(k) * kPace;
      first = part ? std::min(first, middle) : middle;
      last = part ? std::max(last, middle) : middle;
      if (!part) part.emplace().begin = along - stop_line;
      part->end = along - stop_line;
    }
  }
  if (!part) return part;
  part->foe_begin = first + 0.5 * length;
  part->foe_end = last - 0.5 * length;
  return part;
}

/// Adds what a body that takes the link `id` sweeps of the ways of others, as cars drive them.
void add_swept(const Sweeper& sweeper, const RoadNetwork& network, const ConflictTable& conflicts,
               const std::vector<WayOfCar>& ways, ConnectionId id, SweptWayTable& table) {
  const Sweep sweep = sweep_of(sweeper, network, id);
  if (sweep.bodies.empty()) return;
  const EdgeId edge = network.lane(network.connection(id).from).edge;
  for (const WayOfCar& way : ways) {
    const PathLink& link = way.path.links.front();
    const ConnectionId other = link.connection;
    if (network.lane(network.connection(other).from).edge == edge) continue;
    const auto& zones = conflicts[index_of(other)];
    const bool ruled = std::any_of(zones.begin(), zones.end(),
                                   [&](const ConflictZone& zone) { return zone.foe == id; });
    for (const bool wide : {false, true}) {
      const double half_width = wide ? sweeper.half_width_of_wide : sweeper.half_width;
      auto part = swept_part(sweep, sweeper.length, way, ruled ? 0.0 : link.end - link.stop_line,
                             half_width);
      if (!part || part->begin < -kFarthestHalt) continue;
      part->foe = id;
      part->body = sweeper.body;
      part->foe_sweeps = true;
      part->for_wide = wide;
      table[index_of(other)].push_back(*part);
      table[index_of(id)].push_back({other, part->foe_begin, part->foe_end, part->begin, part->end,
                                     sweeper.body, false, wide});
    }
  }
}

void add_swept_ways(const RoadNetwork& network, const ConflictTable& conflicts,
                    const Junction& junction, SweptWayTable& table) {
  const std::vector<ConnectionId> links = driven_links(network, junction);
  std::vector<WayOfCar> ways;
  for (const ConnectionId id : links)
    if (auto way = way_of_car(network, id)) ways.push_back(std::move(*way));
  for (const Sweeper& sweeper : kSweepers)
    for (const ConnectionId id : links) add_swept(sweeper, network, conflicts, ways, id, table);
}

}  // namespace

SweptWayTable find_swept_ways(const RoadNetwork& network, const ConflictTable& conflicts,
                              Workers& workers) {
  SweptWayTable table(network.connections.size());
  // every link belongs to one junction
  workers.for_each_range(network.junctions.size(),
                         [&](std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t i = begin; i < end; ++i)
                             add_swept_ways(network, conflicts, network.junctions[i], table);
                         });
  return table;
}

}  // namespace sumogamma
