#include "osm/swallowed_roads.h"

#include <algorithm>

namespace sumogamma::osm {

namespace {

constexpr double kNear = 8.0;   ///< nodes no further apart may be one junction [m]
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

/// Of a road for wheels: is it drawn outside of both its nodes, or, between a signal and another
/// junction, is nothing left of it for cars? Who waits at that signal would stand on the junction.
bool is_swallowed(const RoadNetwork& road, const Edge& edge) {
  if (edge.kind != LaneKind::Normal || edge.from == kNoJunction || edge.to == kNoJunction)
    return false;
  const Junction &from = road.junctions[index_of(edge.from)],
                 &to = road.junctions[index_of(edge.to)];
  const Vec2 way = to.position - from.position;
  if (way.norm() < 1e-3 || way.norm() > kNear) return false;
  const auto all_lines = [&](const auto& test) {
    return std::all_of(edge.lanes.begin(), edge.lanes.end(),
                       [&](const LaneId id) { return test(road.lane(id).centerline); });
  };
  if (allows(road, edge, ~vehicle_class::kPedestrian) &&
      all_lines([&](const Polyline& line) { return is_drawn_outside(line, from.position, way); }))
    return true;
  return (from.type.starts_with("traffic_light") || to.type.starts_with("traffic_light")) &&
         allows(road, edge, vehicle_class::kPassenger) &&
         all_lines([](const Polyline& line) { return line.length() < kDrawn; });
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
