#include "osm/swallowed_roads.h"

#include <algorithm>

namespace sumogamma::osm {

namespace {

/// Is the edge, for wheels, drawn wholly before the node where it begins, or behind the one where
/// it ends?
bool is_swallowed(const RoadNetwork& road, const Edge& edge) {
  constexpr double kNear = 8.0, kDrawn = 1.0, kLongest = 20.0;  // [m]
  if (edge.kind != LaneKind::Normal || edge.from == kNoJunction || edge.to == kNoJunction)
    return false;
  const Vec2 from = road.junctions[index_of(edge.from)].position;
  const Vec2 way = road.junctions[index_of(edge.to)].position - from;
  const double apart = way.norm();
  if (apart < 1e-3 || apart > kNear) return false;
  const bool walked = std::all_of(edge.lanes.begin(), edge.lanes.end(), [&](const LaneId id) {
    return road.lane(id).allowed == vehicle_class::kPedestrian;
  });
  return !walked && std::all_of(edge.lanes.begin(), edge.lanes.end(), [&](const LaneId id) {
    const Polyline& line = road.lane(id).centerline;
    const double begin = way.dot(line.points().front() - from) / apart,
                 end = way.dot(line.points().back() - from) / apart;
    return line.length() > kDrawn && line.length() < kLongest &&
           (std::max(begin, end) <= 0.0 || std::min(begin, end) >= apart);
  });
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
  std::vector<NodeGroup> groups;
  for (const Edge& edge : road.edges) {
    if (!is_swallowed(road, edge)) continue;
    NodeGroup group = nodes_of(road.junctions[index_of(edge.from)].name);
    group.merge(nodes_of(road.junctions[index_of(edge.to)].name));
    add_group(std::move(group), groups);
  }
  return groups;
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
