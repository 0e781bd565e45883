#include "osm/repairs/swallowed_roads.h"

#include <algorithm>

#include "road/conflict_zones.h"

namespace sumogamma::osm {

namespace {

constexpr double kNear = 8.0;  ///< nodes no further apart may be one junction [m]
constexpr double kWidest =
    24.0;  ///< more of a street is no junction, however close its driveways [m]
constexpr double kDrawn = 1.0;  ///< netconvert leaves no less than 0.1 m of a lane [m]

/// Is a lane drawn wholly before the node where it begins, or behind the one where it ends?
bool is_drawn_outside(const Polyline& line, const Vec2& from, const Vec2& way) {
  constexpr double kLongest = 20.0;  // [m]
  const double apart = way.norm();
  const double begin = way.dot(line.points().front() - from) / apart,
               end = way.dot(line.points().back() - from) / apart;
  return line.length() > kDrawn && line.length() < kLongest &&
         (std::max(begin, end) <= 0.0 || std::min(begin, end) >= apart);
}

bool all_lanes(const RoadNetwork& road, const Edge& edge, const auto& test) {
  return std::all_of(edge.lanes.begin(), edge.lanes.end(),
                     [&](const LaneId id) { return test(road.lane(id).centerline); });
}

/// Is nothing left of a road for cars? Who waits at its end stands on the junction where it begins.
bool leaves_no_room(const RoadNetwork& road, const Edge& edge) {
  return allows(road, edge, vehicle_class::kPassenger) &&
         all_lanes(road, edge, [](const Polyline& line) { return line.length() < kDrawn; });
}

bool is_at_a_signal(const RoadNetwork& road, const Edge& edge) {
  return road.junction(edge.from).type.starts_with("traffic_light") ||
         road.junction(edge.to).type.starts_with("traffic_light");
}

/// Is a road for wheels drawn outside of both its nodes, or does it leave no room for cars?
bool is_swallowed(const RoadNetwork& road, const Edge& edge) {
  const Vec2 &from = road.junction(edge.from).position, &to = road.junction(edge.to).position;
  const Vec2 way = to - from;
  if (way.norm() < 1e-3 || way.norm() > kNear) return false;
  if (allows(road, edge, ~vehicle_class::kPedestrian) &&
      all_lanes(road, edge,
                [&](const Polyline& line) { return is_drawn_outside(line, from, way); }))
    return true;
  return leaves_no_room(road, edge);
}

/// The ways that cars drive over a junction, by link of its matrix.
std::vector<std::pair<ConnectionId, Polyline>> driven_ways(const RoadNetwork& road,
                                                           const Junction& junction) {
  std::vector<std::pair<ConnectionId, Polyline>> ways;
  for (const ConnectionId id : driven_links(road, junction))
    if ((road.lane(road.connection(id).from).allowed & road.lane(road.connection(id).to).allowed &
         vehicle_class::kPassenger) != 0)
      ways.emplace_back(id, link_geometry(road, id));
  return ways;
}

bool meet(const Polyline& a, const Polyline& b) {
  constexpr double kStep = 0.5, kBody = 2.0;  // [m]
  for (double along = 0; along < a.length() + kStep; along += kStep)
    if (b.project(a.point_at(along)).distance < kBody) return true;
  return false;
}

/// Does anybody who drives over one end of the road meet others who do over the other end, though
/// neither of them follows the other over both?
bool ways_meet(const RoadNetwork& road, const Edge& edge) {
  const auto behind = driven_ways(road, road.junction(edge.to));
  for (const auto& [id, way] : driven_ways(road, road.junction(edge.from))) {
    const Connection& link = road.connection(id);
    for (const auto& [other_id, other_way] : behind) {
      const Connection& other = road.connection(other_id);
      const bool follow = road.lane(link.to).edge == road.lane(other.from).edge ||
                          road.lane(other.to).edge == road.lane(link.from).edge;
      if (!follow && meet(way, other_way)) return true;
    }
  }
  return false;
}

/// Nodes to join, and where the junctions are that they belong to.
struct Cluster {
  NodeGroup nodes;
  std::vector<Vec2> places;
};

double extent_of(const std::vector<Vec2>& places) {
  double extent = 0;
  for (const Vec2& a : places)
    for (const Vec2& b : places) extent = std::max(extent, (a - b).norm());
  return extent;
}

/// The nodes of the junctions at the ends of roads that the test tells. Roads that follow each
/// other are joined as long as their junctions lie no further apart than `widest` [m].
std::vector<NodeGroup> groups_by_road(const RoadNetwork& road, double widest, const auto& test) {
  std::vector<Cluster> clusters;
  for (const Edge& edge : road.edges) {
    if (edge.kind != LaneKind::Normal || edge.from == kNoJunction || edge.to == kNoJunction ||
        !test(road, edge))
      continue;
    Cluster joined{nodes_of(road.junction(edge.from).name),
                   {road.junction(edge.from).position, road.junction(edge.to).position}};
    joined.nodes.merge(nodes_of(road.junction(edge.to).name));
    const double own = extent_of(joined.places);
    const auto meets = [&](const Cluster& known) {
      return std::any_of(known.nodes.begin(), known.nodes.end(),
                         [&](const std::string& node) { return joined.nodes.contains(node); });
    };
    Cluster whole = joined;
    for (const Cluster& known : clusters)
      if (meets(known)) {
        whole.nodes.insert(known.nodes.begin(), known.nodes.end());
        whole.places.insert(whole.places.end(), known.places.begin(), known.places.end());
      }
    if (extent_of(whole.places) > std::max(widest, own)) continue;
    std::erase_if(clusters, meets);
    clusters.push_back(std::move(whole));
  }
  std::vector<NodeGroup> groups;
  for (Cluster& cluster : clusters) groups.push_back(std::move(cluster.nodes));
  return groups;
}

}  // namespace

NodeGroup nodes_of(const std::string& junction) {
  static const std::string kCluster = "cluster_";
  if (!junction.starts_with(kCluster)) return {junction};
  NodeGroup nodes;
  for (std::size_t begin = kCluster.size(); begin < junction.size();) {
    const std::size_t end = std::min(junction.find('_', begin), junction.size());
    if (junction[begin] != '#') nodes.insert(junction.substr(begin, end - begin));
    begin = end + 1;
  }
  return nodes;
}

std::vector<NodeGroup> swallowed_roads(const RoadNetwork& road) {
  return groups_by_road(road, kWidest, is_swallowed);
}

std::vector<NodeGroup> signals_on_ways(const RoadNetwork& road) {
  constexpr double kAnyWidth = 1e9;
  return groups_by_road(road, kAnyWidth, [](const RoadNetwork& network, const Edge& edge) {
    return leaves_no_room(network, edge) && is_at_a_signal(network, edge) &&
           ways_meet(network, edge);
  });
}

void add_group(NodeGroup group, std::vector<NodeGroup>& groups) {
  std::erase_if(groups, [&](NodeGroup& known) {
    const bool meets = std::any_of(known.begin(), known.end(),
                                   [&](const std::string& node) { return group.contains(node); });
    if (meets) group.merge(known);
    return meets;
  });
  groups.push_back(std::move(group));
}

}  // namespace sumogamma::osm
