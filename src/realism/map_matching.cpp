#include "realism/map_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/units.h"
#include "road/route_search.h"

namespace sumogamma {

namespace {

constexpr std::size_t kEvery = 5;       // steps from one point to the next
constexpr double kWalkReach = 10.0;     // [m]
constexpr std::size_t kCandidates = 4;  // of edges at a point
constexpr std::size_t kAtEnd = 6;       // points at either end
constexpr double kBesideLane = 4.0;     // from a lane to the next one [m]

/// A place on a lane.
struct MatchedPlace {
  LaneId lane = kNoLane;
  double along = 0, distance = 0;
};

/// Every kEvery-th pose, and the last.
std::vector<std::size_t> points_of(const RecordedAgent& agent) {
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k < agent.position.size(); k += kEvery) points.push_back(k);
  if (points.back() + 1 != agent.position.size()) points.push_back(agent.position.size() - 1);
  return points;
}

/// The normal lane that a lane on a junction comes from (or leads to), itself where it is one.
MatchedPlace off_junction(const RoadNetwork& network, MatchedPlace place, bool backwards) {
  // a chain of internal lanes has few members
  for (int k = 0; k < 8 && network.lane(place.lane).kind == LaneKind::Internal; ++k) {
    const Lane& lane = network.lane(place.lane);
    const std::vector<ConnectionId>& links = backwards ? lane.incoming : lane.outgoing;
    if (!links.empty()) {
      const Connection& link = network.connection(links.front());
      place.lane = backwards ? link.from : link.to;
    } else {
      // the first internal lane of a link is told by the link alone
      const auto link = std::find_if(network.connections.begin(), network.connections.end(),
                                     [&](const Connection& one) { return one.via == place.lane; });
      if (link == network.connections.end()) break;
      place.lane = backwards ? link->from : link->to;
    }
    place.along = backwards ? network.lane(place.lane).centerline.length() : 0.0;
  }
  return place;
}

/// Lanes under a point of a vehicle, the nearest first, each edge once.
std::vector<MatchedPlace> lanes_at(const RoadNetwork& network, const Vec2& point, double heading,
                                   VehicleClassMask classes, bool backwards) {
  std::vector<MatchedPlace> places;
  for (std::size_t k = 0; k < network.lanes.size(); ++k) {
    const Lane& lane = network.lanes[k];
    const bool drives = lane.kind == LaneKind::Normal || lane.kind == LaneKind::Internal;
    if (!drives || (lane.allowed & classes) == 0 || lane.centerline.empty()) continue;
    const PolylinePosition at = lane.centerline.project(point);
    if (at.distance > kOnRoute) continue;
    const double direction = heading_of(lane.centerline.direction_at(at.along));
    if (std::abs(wrap_angle(direction - heading)) > radians(kSameWay)) continue;
    const MatchedPlace place =
        off_junction(network, {static_cast<LaneId>(k), at.along, at.distance}, backwards);
    if (network.lane(place.lane).kind == LaneKind::Normal) places.push_back(place);
  }
  std::stable_sort(places.begin(), places.end(), [](const MatchedPlace& a, const MatchedPlace& b) {
    return a.distance < b.distance;
  });
  std::set<EdgeId> seen;
  std::erase_if(places, [&](const MatchedPlace& place) {
    return !seen.insert(network.lane(place.lane).edge).second;
  });
  if (places.size() > kCandidates) places.resize(kCandidates);
  return places;
}

/// The lanes of a route and those over its junctions.
std::set<LaneId> lanes_of(const RoadNetwork& network, const std::vector<EdgeId>& edges) {
  std::set<LaneId> lanes;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    for (const LaneId id : network.edge(edges[k]).lanes) {
      lanes.insert(id);
      if (k + 1 == edges.size()) continue;
      for (const ConnectionId link : network.lane(id).outgoing) {
        if (network.lane(network.connection(link).to).edge != edges[k + 1]) continue;
        // one after another over the junction
        LaneId via = network.connection(link).via;
        while (via != kNoLane && lanes.insert(via).second) {
          const std::vector<ConnectionId>& onward = network.lane(via).outgoing;
          via = onward.empty() ? kNoLane : network.connection(onward.front()).via;
        }
      }
    }
  }
  return lanes;
}

std::size_t points_near(const RoadNetwork& network, const std::set<LaneId>& lanes,
                        const RecordedAgent& agent, const std::vector<std::size_t>& points) {
  const auto is_near = [&](std::size_t k) {
    return std::any_of(lanes.begin(), lanes.end(), [&](LaneId id) {
      return network.lane(id).centerline.project(agent.position[k]).distance <= kOnRoute;
    });
  };
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), is_near));
}

/// The fastest way from any lane of one edge to another; the edge alone where it is the same.
std::vector<EdgeId> way_between(const RoadNetwork& network, const MatchedPlace& from,
                                const MatchedPlace& to, VehicleClassMask classes,
                                const std::vector<double>& times) {
  const EdgeId start = network.lane(from.lane).edge, end = network.lane(to.lane).edge;
  if (start == end && to.along >= from.along) return {start};
  std::vector<EdgeId> best;
  double least = std::numeric_limits<double>::infinity();
  for (const LaneId lane : network.edge(start).lanes) {
    std::vector<EdgeId> way = fastest_route(network, lane, end, classes, times);
    double time = 0;
    for (const EdgeId edge : way) time += times[index_of(edge)];
    if (way.empty() || time >= least) continue;
    least = time;
    best = std::move(way);
  }
  return best;
}

/// Lanes under the first (or last) few of the points, each edge once: who changes lanes there may
/// be beside the one that it goes on by. At the middle of the points where there is none nearer.
std::vector<MatchedPlace> end_of(const RoadNetwork& network, const RecordedAgent& agent,
                                 std::vector<std::size_t> points, VehicleClassMask classes,
                                 bool first) {
  if (!first) std::reverse(points.begin(), points.end());
  std::vector<MatchedPlace> places;
  std::set<EdgeId> seen;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (k >= kAtEnd && !places.empty()) break;
    for (MatchedPlace place :
         lanes_at(network, agent.position[points[k]], agent.heading[points[k]], classes, first)) {
      if (!seen.insert(network.lane(place.lane).edge).second) continue;
      // the end itself lies there, too, as far as the lane goes
      const Polyline& line = network.lane(place.lane).centerline;
      const PolylinePosition end = line.project(agent.position[points[0]]);
      if (end.distance < kBesideLane) place.along = end.along;
      places.push_back(place);
    }
  }
  return places;
}

/// The nearest lane for people.
MatchedPlace sidewalk_at(const RoadNetwork& network, const Vec2& point) {
  MatchedPlace nearest{kNoLane, 0.0, kWalkReach};
  for (std::size_t k = 0; k < network.lanes.size(); ++k) {
    const Lane& lane = network.lanes[k];
    if (lane.kind != LaneKind::Normal || (lane.allowed & vehicle_class::kPedestrian) == 0) continue;
    const PolylinePosition at = lane.centerline.project(point);
    if (at.distance < nearest.distance) nearest = {static_cast<LaneId>(k), at.along, at.distance};
  }
  return nearest;
}

}  // namespace

MatchedRoute match_route(const RoadNetwork& network, const RecordedAgent& agent,
                         VehicleClassMask classes) {
  const std::vector<std::size_t> points = points_of(agent);
  const std::vector<double> times = free_travel_times(network);
  MatchedRoute best;
  best.points = points.size();
  for (const MatchedPlace& from : end_of(network, agent, points, classes, true))
    for (const MatchedPlace& to : end_of(network, agent, points, classes, false)) {
      std::vector<EdgeId> way = way_between(network, from, to, classes, times);
      if (way.empty()) continue;
      const std::size_t near = points_near(network, lanes_of(network, way), agent, points);
      if (!best.edges.empty() && near <= best.near) continue;
      const EdgeId last = way.back();
      best = {std::move(way), from.lane, from.along, to.along, points.size(), near, last};
    }
  return best;
}

MatchedWalk match_walk(const RoadNetwork& network, const RecordedAgent& agent) {
  const MatchedPlace from = sidewalk_at(network, agent.position.front());
  const MatchedPlace to = sidewalk_at(network, agent.position.back());
  if (from.lane == kNoLane || to.lane == kNoLane) return {};
  return {network.lane(from.lane).edge, network.lane(to.lane).edge, from.along, to.along};
}

}  // namespace sumogamma
