#include "road/overpasses.h"

#include <algorithm>
#include <utility>

namespace sumogamma {

namespace {

constexpr double kFromEnds = 12.0;      // nearer than that roads may overlap as they meet [m]
constexpr double kLeastSine = 0.5;      // parallel roads that touch don't cross [sin of the angle]
constexpr double kRise = 1.5;           // over or under a link, which may only pass by roads [m]
constexpr double kShortestLoop = 40.0;  // lanes at the inside of hairpins fold over themselves [m]

// where a footway crosses a road with no node in common, people cross the road
constexpr VehicleClassMask kMotorised = vehicle_class::kPassenger | vehicle_class::kDelivery |
                                        vehicle_class::kTruck | vehicle_class::kBus;

struct RoadAxis {
  EdgeId edge;
  const Lane* lane;
  Vec2 lower, upper;  ///< corners of its box [m]
};

RoadAxis road_on(EdgeId edge, const Lane& lane) {
  const std::vector<Vec2>& points = lane.centerline.points();
  RoadAxis road{edge, &lane, points.front(), points.front()};
  for (const Vec2& point : points) {
    road.lower = road.lower.cwiseMin(point);
    road.upper = road.upper.cwiseMax(point);
  }
  return road;
}

/// Do the boxes of two roads touch?
bool are_near(const RoadAxis& a, const RoadAxis& b) {
  return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}

/// With their first lanes for motor vehicles.
std::vector<RoadAxis> roads_of(const RoadNetwork& network) {
  std::vector<RoadAxis> roads;
  for (std::size_t i = 0; i < network.edges.size(); ++i) {
    const Edge& edge = network.edges[i];
    if (edge.kind != LaneKind::Normal) continue;
    const auto lane = std::find_if(edge.lanes.begin(), edge.lanes.end(), [&](LaneId id) {
      return (network.lane(id).allowed & kMotorised) != 0;
    });
    if (lane == edge.lanes.end()) continue;
    if (network.lane(*lane).centerline.points().size() < 2) continue;
    roads.push_back(road_on(EdgeId(static_cast<int>(i)), network.lane(*lane)));
  }
  return roads;
}

bool is_far_from_ends(const Polyline& line, double along) {
  return along > kFromEnds && along < line.length() - kFromEnds;
}

/// True where the map has the roads on different layers and no junction joins them: they cross,
/// however near to their ends.
bool are_apart(const RoadNetwork& network, const RoadAxis& one, const RoadAxis& other) {
  const Edge &a = network.edge(one.edge), &b = network.edge(other.edge);
  return one.lane->layer != other.lane->layer && a.from != b.from && a.from != b.to &&
         a.to != b.from && a.to != b.to;
}

/// Calls visit(here, there, along, across) where two lines (or one and itself) cross: the places on
/// both [m] and the pieces that cross.
template <class Visit>
void for_each_crossing(const Polyline& own, const Polyline& their, const Visit& visit) {
  const std::vector<Vec2>&a = own.points(), &b = their.points();
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    const Vec2 along = a[i + 1] - a[i];
    for (std::size_t j = &own == &their ? i + 2 : 0; j + 1 < b.size(); ++j) {
      const Vec2 across = b[j + 1] - b[j];
      const auto share = crossing_shares(a[i], along, b[j], across);
      if (!share || share->minCoeff() < 0.0 || share->maxCoeff() > 1.0) continue;
      visit(own.along_of_vertex(i) + share->x() * along.norm(),
            their.along_of_vertex(j) + share->y() * across.norm(), along, across);
    }
  }
}

/// Adds where two centerlines (or one and itself) cross.
void add_crossings(const RoadAxis& one, const RoadAxis& other, RoadNetwork& network) {
  const Polyline &own = one.lane->centerline, &their = other.lane->centerline;
  const bool same = one.edge == other.edge,
             opposite = are_opposite(network.edge(one.edge), network.edge(other.edge)),
             apart = are_apart(network, one, other);
  for_each_crossing(
      own, their, [&](double here, double there, const Vec2& along, const Vec2& across) {
        if (std::abs(cross(along, across)) < kLeastSine * along.norm() * across.norm()) return;
        if (same && there - here < kShortestLoop) return;
        if (opposite && std::abs(here - (their.length() - there)) < kShortestLoop) return;
        if (apart || (is_far_from_ends(own, here) && is_far_from_ends(their, there)))
          network.overpasses.push_back({one.edge, other.edge, here, there});
      });
}

/// Adds where a link crosses a road that doesn't come to its junction, a storey higher or lower:
/// the lane that leads into it and the one behind cross that road as well, beyond their ends.
void add_crossings_of_link(const Connection& link, const std::vector<RoadAxis>& roads,
                           RoadNetwork& network) {
  const Lane& via = network.lane(link.via);
  const RoadAxis own = road_on(via.edge, via);
  for (const RoadAxis& road : roads) {
    const Edge& edge = network.edge(road.edge);
    if (edge.from == via.junction || edge.to == via.junction || !are_near(own, road)) continue;
    const auto add = [&](LaneId lane, double along, double there) {
      const EdgeId its = network.lane(lane).edge;
      network.overpasses.push_back(its < road.edge ? Overpass{its, road.edge, along, there}
                                                   : Overpass{road.edge, its, there, along});
    };
    for_each_crossing(
        via.centerline, road.lane->centerline,
        [&](double here, double there, const Vec2& /*along*/, const Vec2& /*across*/) {
          const double rise = elevation_at(via, here) - elevation_at(*road.lane, there);
          if (std::abs(rise) < kRise) return;
          add(link.from, network.lane(link.from).centerline.length() + here, there);
          add(link.via, here, there);
          add(link.to, here - via.centerline.length(), there);
        });
  }
}

}  // namespace

void find_overpasses(RoadNetwork& network) {
  network.overpasses.clear();
  for (Lane& lane : network.lanes) lane.has_overpass = false;
  std::vector<RoadAxis> roads = roads_of(network);
  std::sort(roads.begin(), roads.end(), [](const RoadAxis& a, const RoadAxis& b) {
    return a.lower.x() != b.lower.x() ? a.lower.x() < b.lower.x() : a.edge < b.edge;
  });
  auto by_edge = [](const RoadAxis& a, const RoadAxis& b) { return a.edge < b.edge; };
  for (auto one = roads.begin(); one != roads.end(); ++one)
    for (auto other = one; other != roads.end() && other->lower.x() <= one->upper.x(); ++other) {
      if (!are_near(*one, *other)) continue;
      const auto& [first, second] = std::minmax(*one, *other, by_edge);
      add_crossings(first, second, network);
    }
  for (const Connection& link : network.connections)
    if (link.via != kNoLane && (network.lane(link.via).allowed & kMotorised) != 0 &&
        !network.lane(link.via).elevation.empty())
      add_crossings_of_link(link, roads, network);
  std::stable_sort(network.overpasses.begin(), network.overpasses.end(),
                   [](const Overpass& a, const Overpass& b) {
                     return std::pair(a.one, a.other) < std::pair(b.one, b.other);
                   });
  for (const Overpass& overpass : network.overpasses)
    for (const EdgeId edge : {overpass.one, overpass.other})
      for (const LaneId lane : network.edge(edge).lanes)
        network.lanes[index_of(lane)].has_overpass = true;
}

}  // namespace sumogamma
