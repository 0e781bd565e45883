#include "road/stop_lines.h"

#include <algorithm>
#include <limits>

#include "road/conflict_zones.h"
#include "road/path_pieces.h"

namespace sumogamma {

namespace {

// between the middles of a waiting and a turning vehicle: as wide as roads are; on paths as
// bicycles turn, and of those who have turned a share of the widths [m]
constexpr double kRoom = 2.9, kRoomToTurn = 1.9, kRoomOfWidth = 0.95;
constexpr double kFarthest = 30.0;  ///< a junction joined out of several is as wide [m]
constexpr double kBody = 6.0;       ///< of a waiting vehicle, behind its front [m]
constexpr double kStep = 0.5;       ///< [m]
constexpr double kAfter = 10.0;     ///< of the road turned into that is looked at [m]

/// The way over a junction, the one into the road behind it, and how wide that is [m].
struct Way {
  Polyline link, after;
  double width = 0;
  Vec2 lower = Vec2::Constant(std::numeric_limits<double>::infinity()),
       upper = -lower;  ///< corners of a box about all that is near to it [m]
};

Way way_through(const RoadNetwork& network, ConnectionId id) {
  const Lane& to = network.lane(network.connection(id).to);
  std::vector<Vec2> after;
  append_span(to.centerline, 0.0, std::min(kAfter, to.centerline.length()), after);
  Way way{link_geometry(network, id), Polyline(after), to.width};
  const Vec2 margin = Vec2::Constant(kRoom + 1e-6);
  for (const Polyline* line : {&way.link, &way.after})
    for (const Vec2& point : line->points()) {
      way.lower = way.lower.cwiseMin(point - margin);
      way.upper = way.upper.cwiseMax(point + margin);
    }
  return way;
}

/// Is a place on a lane so near to a way that who waits there is in the way?
bool is_near(const Vec2& place, const Lane& lane, const Way& way) {
  if ((place.array() < way.lower.array()).any() || (place.array() > way.upper.array()).any())
    return false;
  const double beside = std::min(kRoom, kRoomOfWidth * 0.5 * (lane.width + way.width));
  return way.after.project(place).distance < beside ||
         way.link.project(place).distance < std::min(kRoom, std::max(beside, kRoomToTurn));
}

/// How far before its end the front must halt on `lane` so that none of the places from there to
/// 6 m behind it lies on the `ways` of those who come otherwise; 0 where that is too far.
double setback_on(const Lane& lane, const std::vector<Way>& ways) {
  const Polyline& line = lane.centerline;
  const double length = line.length();
  double clear_from = 0.0;
  for (double back = 0.0; back <= std::min(kFarthest + kBody, length); back += kStep) {
    const Vec2 place = line.point_at(length - back);
    if (std::any_of(ways.begin(), ways.end(),
                    [&](const Way& way) { return is_near(place, lane, way); }))
      clear_from = back + kStep;
  }
  return clear_from <= std::min(kFarthest, 0.5 * length) ? clear_from : 0.0;
}

/// Middle lines of all ways over a junction that vehicles drive.
std::vector<Polyline> driven_ways(const RoadNetwork& network, const Junction& junction) {
  std::vector<Polyline> ways;
  for (const ConnectionId id : driven_links(network, junction))
    ways.push_back(link_geometry(network, id));
  return ways;
}

/// Is a place `room` [m] or more from the middles of all who drive one of the ways?
bool is_off(const std::vector<Polyline>& ways, const Vec2& place, double room) {
  return std::none_of(ways.begin(), ways.end(),
                      [&](const Polyline& way) { return way.project(place).distance < room; });
}

/// Has who waits on a walk, with the front at `halt`, room off the ways? Sets the sides of that
/// room, the part nearest to the path where there are several.
bool has_waiting_room(const Path& path, double halt, const std::vector<Polyline>& ways, double room,
                      PathLink& link) {
  constexpr double kStands = 0.8;     // before the halt: the middle of who waits [m]
  constexpr double kFarAside = 1.2;   // of the path [m]
  constexpr double kStepAside = 0.2;  // [m]
  const Vec2 front = path.line.point_at(halt), middle = path.line.point_at(halt - kStands);
  const Vec2 left = left_of(path.line.direction_at(halt));
  auto is_free = [&](double side) {
    return is_off(ways, front + side * left, room) && is_off(ways, middle + side * left, room);
  };
  // how far the room goes on from `side` to the left (1) or right (-1): infinite where nothing
  // bounds it
  auto edge = [&](double side, double to) {
    while (to * side < kFarAside && is_free(side + to * kStepAside)) side += to * kStepAside;
    return to * side < kFarAside ? side : to * std::numeric_limits<double>::infinity();
  };
  for (double aside = 0.0; aside < kFarAside; aside += kStepAside)
    for (const double side : {aside, -aside}) {
      if (!is_free(side)) continue;
      link.halt_left = edge(side, 1.0);
      link.halt_right = edge(side, -1.0);
      return true;
    }
  return false;
}

/// Where on a walk, at a link's stop line or so far before it as it takes, there is room off the
/// ways; no further back than `least` [m]. At signals a step back where that leaves drivers more
/// room: they creep past whom they nearly touch, and lorries reach further than cars. Elsewhere
/// drivers wait for whoever is at the kerb, and from further back that takes longer.
void halt_off(const Path& path, double least, const std::vector<Polyline>& ways, bool signalled,
              PathLink& link) {
  constexpr double kMost = 10.0, kStepBack = 0.8;   // [m]
  constexpr double kWalkerStep = 0.4;               // [m]
  constexpr double kJustOff = 1.55, kAtEase = 2.1;  // between the middles [m]
  const double most = std::min(kMost, link.stop_line - least);
  link.halt = link.stop_line;
  double back = 0.0;
  auto find = [&](double room, double to) {
    for (double at = back; at <= std::min(to, most); at += kWalkerStep)
      if (has_waiting_room(path, link.stop_line - at, ways, room, link)) {
        back = at;
        return true;
      }
    return false;
  };
  if (!find(kJustOff, most)) return;
  if (signalled) find(kAtEase, back + kStepBack);
  link.halt = link.stop_line - back;
}

/// Where the fronts on the lanes before a junction halt that `links` lead over.
void set_back(const std::vector<ConnectionId>& links, RoadNetwork& network) {
  std::vector<Way> ways;
  ways.reserve(links.size());
  for (const ConnectionId id : links) ways.push_back(way_through(network, id));
  for (const ConnectionId id : links) {
    const Lane& lane = network.lane(network.connection(id).from);
    std::vector<Way> others;
    for (std::size_t k = 0; k < links.size(); ++k)
      if (network.lane(network.connection(links[k]).from).edge != lane.edge)
        others.push_back(ways[k]);
    network.connections[index_of(id)].setback = setback_on(lane, others);
  }
}

}  // namespace

void halt_off_the_road(const RoadNetwork& network, Path& path) {
  // the crossings of one junction follow each other
  JunctionId last = kNoJunction;
  std::vector<Polyline> ways;
  double crossed = 0.0;  // nobody goes back over a crossing to wait for the next one
  for (PathLink& link : path.links) {
    const JunctionId junction = network.connection(link.connection).junction;
    if (junction == kNoJunction) continue;
    if (junction != last) ways = driven_ways(network, network.junction(junction));
    last = junction;
    const bool signalled = network.connection(link.connection).signal != kNoSignal;
    halt_off(path, crossed, ways, signalled, link);
    crossed = link.end;
  }
}

void set_back_stop_lines(RoadNetwork& network, Workers& workers) {
  std::vector<std::vector<ConnectionId>> by_junction(network.junctions.size());
  for (std::size_t i = 0; i < network.connections.size(); ++i) {
    const auto id = static_cast<ConnectionId>(i);
    if (is_driven(network, id))
      by_junction[index_of(network.connections[i].junction)].push_back(id);
  }
  workers.for_each_range(by_junction.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) set_back(by_junction[i], network);
  });
}

}  // namespace sumogamma
