#include "road/stop_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/oriented_box.h"
#include "road/conflict_zones.h"
#include "road/path_profile.h"

namespace sumogamma {

namespace {

constexpr double kRoom = 2.9;       ///< between the middles of a waiting and a turning vehicle [m]
constexpr double kFarthest = 10.0;  ///< [m]
constexpr double kBody = 6.0;       ///< of a waiting vehicle, behind its front [m]
constexpr double kStep = 0.5;       ///< [m]
constexpr double kAfter = 10.0;     ///< of the road turned into that is looked at [m]

/// The way over a junction and into the road behind it.
Polyline way_through(const RoadNetwork& network, ConnectionId id) {
  const Polyline& after = network.lane(network.connection(id).to).centerline;
  std::vector<Vec2> points = link_geometry(network, id).points();
  append_span(after, 0.0, std::min(kAfter, after.length()), points);
  return Polyline(std::move(points));
}

bool is_driven(const RoadNetwork& network, const Connection& connection) {
  return connection.via != kNoLane && connection.junction != kNoJunction &&
         network.lane(connection.from).kind == LaneKind::Normal &&
         network.lane(connection.to).kind == LaneKind::Normal;
}

// the longest body that turns anywhere, a bus: its ends swing out
constexpr double kBusLength = 12.0, kBusWidth = 2.5, kBusAxle = 2.7, kBusRadius = 6.6;  // [m]

/// What a bus sweeps that goes over a junction by a link and turns there: its body at each metre.
/// Its middle follows the way, its rear axle lies kBusAxle behind. Empty for a link that is
/// straight.
std::vector<OrientedBox> sweep_of_bus(const RoadNetwork& network, ConnectionId id) {
  constexpr double kTurns = 0.35;  // [rad]
  constexpr double kPace = 0.5;    // [m]
  const Connection& connection = network.connection(id);
  if ((network.lane(connection.to).allowed & vehicle_class::kBus) == 0) return {};
  const Polyline& before = network.lane(connection.from).centerline;
  const Polyline& after = network.lane(connection.to).centerline;
  const Vec2 leaves = after.direction_at(0.0);
  if (before.direction_at(before.length()).dot(leaves) > std::cos(kTurns)) return {};
  std::vector<Vec2> points;
  append_span(before, std::max(0.0, before.length() - kBusLength), before.length(), points);
  append_span(link_geometry(network, id), 0.0, link_geometry(network, id).length(), points);
  append_span(after, 0.0, std::min(2.0 * kBusLength, after.length()), points);
  Path path;
  path.line = Polyline(std::move(points));
  round_corners(kBusRadius, path);
  std::vector<OrientedBox> sweep;
  double heading = heading_of(path.line.direction_at(0.0));
  for (double along = 0.0; along <= path.line.length(); along += kPace) {
    const Vec2 forward = direction_of(heading);
    sweep.push_back({path.line.point_at(along), forward, {0.5 * kBusLength, 0.5 * kBusWidth}});
    heading += kPace * cross(forward, path.line.direction_at(along)) / kBusAxle;
  }
  return sweep;
}

/// What those who come by other ways leave of a lane's end.
struct Ways {
  std::vector<Polyline> middles;
  std::vector<OrientedBox> bodies;
};

/// How far before its end the front must halt on `lane` so that none of the places from there to
/// 6 m behind it is `touched`; 0 where that is too far.
template <typename Touched>
double clear_place(const Lane& lane, Touched&& touched) {
  const Polyline& line = lane.centerline;
  const double length = line.length();
  double clear_from = 0.0;
  for (double back = 0.0; back <= std::min(kFarthest + kBody, length); back += kStep)
    if (touched(line.point_at(length - back), line.direction_at(length - back)))
      clear_from = back + kStep;
  return clear_from <= std::min(kFarthest, 0.5 * length) ? clear_from : 0.0;
}

/// How far before its end the front must halt on `lane` to leave room for those on `ways`: for
/// buses, too, where that can be had.
double setback_on(const Lane& lane, const Ways& ways) {
  constexpr double kHalfWidth = 1.3;  // of who waits, and some [m]
  const auto near_way = [&](const Vec2& place, const Vec2&) {
    return std::any_of(ways.middles.begin(), ways.middles.end(),
                       [&](const Polyline& way) { return way.project(place).distance < kRoom; });
  };
  const auto in_sweep = [&](const Vec2& place, const Vec2& forward) {
    const OrientedBox slice{place, forward, {0.5 * kStep, kHalfWidth}};
    return std::any_of(ways.bodies.begin(), ways.bodies.end(), [&](const OrientedBox& body) {
      return (body.center - place).norm() < kBusLength && separation(slice, body) < 0.0;
    });
  };
  const double for_all = clear_place(lane, [&](const Vec2& place, const Vec2& forward) {
    return near_way(place, forward) || in_sweep(place, forward);
  });
  return for_all > 0.0 ? for_all : clear_place(lane, near_way);
}

/// Middle lines of all ways over a junction that vehicles drive.
std::vector<Polyline> driven_ways(const RoadNetwork& network, const Junction& junction) {
  std::vector<Polyline> ways;
  for (const ConnectionId id : junction.links)
    if (id != kNoConnection && is_driven(network, network.connection(id)))
      ways.push_back(link_geometry(network, id));
  return ways;
}

/// Where on a walk, at `along` or so far before it as it takes, nobody drives.
double off_the_road(const Path& path, double along, const std::vector<Polyline>& ways) {
  constexpr double kWalkerRoom = 1.55;  // between the middles of a vehicle and a walker [m]
  constexpr double kMost = 10.0;        // [m]
  constexpr double kWalkerStep = 0.4;   // [m]
  for (double back = 0.0; back <= std::min(kMost, along); back += kWalkerStep) {
    const Vec2 place = path.line.point_at(along - back);
    const bool driven = std::any_of(ways.begin(), ways.end(), [&](const Polyline& way) {
      return way.project(place).distance < kWalkerRoom;
    });
    if (!driven) return along - back;
  }
  return along;
}

}  // namespace

void halt_off_the_road(const RoadNetwork& network, Path& path) {
  // the crossings of one junction follow each other
  JunctionId last = kNoJunction;
  std::vector<Polyline> ways;
  for (PathLink& link : path.links) {
    const JunctionId junction = network.connection(link.connection).junction;
    if (junction == kNoJunction) continue;
    if (junction != last) ways = driven_ways(network, network.junction(junction));
    last = junction;
    link.halt = off_the_road(path, link.stop_line, ways);
  }
}

void set_back_stop_lines(RoadNetwork& network) {
  std::vector<std::vector<ConnectionId>> by_junction(network.junctions.size());
  for (std::size_t i = 0; i < network.connections.size(); ++i) {
    const Connection& connection = network.connections[i];
    if (is_driven(network, connection))
      by_junction[index_of(connection.junction)].push_back(static_cast<ConnectionId>(i));
  }
  for (const std::vector<ConnectionId>& links : by_junction) {
    std::vector<Polyline> ways;
    std::vector<std::vector<OrientedBox>> sweeps;
    for (const ConnectionId id : links) {
      ways.push_back(way_through(network, id));
      sweeps.push_back(sweep_of_bus(network, id));
    }
    for (const ConnectionId id : links) {
      const Lane& lane = network.lane(network.connection(id).from);
      Ways others;
      for (std::size_t k = 0; k < links.size(); ++k) {
        if (network.lane(network.connection(links[k]).from).edge == lane.edge) continue;
        others.middles.push_back(ways[k]);
        others.bodies.insert(others.bodies.end(), sweeps[k].begin(), sweeps[k].end());
      }
      network.connections[index_of(id)].setback = setback_on(lane, others);
    }
  }
}

}  // namespace sumogamma
