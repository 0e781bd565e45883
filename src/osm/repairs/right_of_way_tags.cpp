#include "osm/repairs/right_of_way_tags.h"

#include <algorithm>
#include <set>

#include "osm/repairs/swallowed_roads.h"

namespace sumogamma::osm {
namespace {

/// netconvert's names of edges driven against their way begin with a minus.
int direction_of(const std::string& edge) { return edge.starts_with('-') ? -1 : 1; }

/// Does a sign face those who come along the edge?
bool faces(const WayApproach& sign, const std::string& edge, const std::set<std::int64_t>& ways) {
  return sign.direction == direction_of(edge) && ways.contains(sign.way);
}

/// All signs at a junction that was made of one node or of several.
std::vector<WayApproach> signs_at(const std::string& junction, const SignsByJunction& signs) {
  std::vector<WayApproach> here;
  const NodeGroup made_of = nodes_of(junction);
  for (const auto& [node, facing] : signs)
    if (made_of.contains(std::to_string(node)))
      here.insert(here.end(), facing.begin(), facing.end());
  return here;
}

}  // namespace

std::map<std::string, std::string> stop_types(const RoadNetwork& road,
                                              const SignsByJunction& stop) {
  std::map<std::string, std::string> types;
  if (stop.empty()) return types;
  std::map<JunctionId, std::size_t> approaches;
  for (const Edge& edge : road.edges)
    if (edge.kind == LaneKind::Normal && allows(road, edge, vehicle_class::kPassenger))
      ++approaches[edge.to];
  for (const auto& [node, signs] : stop) {
    const auto junction = road.junction_by_name.find(std::to_string(node));
    if (junction == road.junction_by_name.end()) continue;
    const std::string& type = road.junction(junction->second).type;
    const bool everywhere = signs.size() >= approaches[junction->second];
    if (type == "priority" || (type == "right_before_left" && everywhere))
      types[std::to_string(node)] = everywhere ? "allway_stop" : "priority_stop";
  }
  return types;
}

std::vector<std::string> mini_roundabouts(const RoadNetwork& road, const OsmMap& map) {
  std::set<std::string> nodes;
  for (const auto& [id, node] : map.nodes)
    if (tag_is(node.tags, "highway", {"mini_roundabout"})) nodes.insert(std::to_string(id));
  std::vector<std::string> names;
  for (const Junction& junction : road.junctions) {
    if (junction.type != "priority" && junction.type != "right_before_left") continue;
    const NodeGroup made_of = nodes_of(junction.name);
    if (std::any_of(made_of.begin(), made_of.end(),
                    [&](const std::string& node) { return nodes.contains(node); }))
      names.push_back(junction.name);
  }
  return names;
}

std::vector<Prohibition> give_way_rules(const NetworkFile& network,
                                        const SignsByJunction& give_way) {
  if (give_way.empty()) return {};
  const RoadNetwork& road = network.road;
  const auto ways = ways_of_edges(network.net());
  const auto edge_at = [&](LaneId lane) -> const std::string& {
    return road.edge(road.lane(lane).edge).name;
  };
  std::set<Prohibition> rules;
  for (const Junction& junction : road.junctions) {
    if (junction.type != "priority" && junction.type != "right_before_left") continue;
    const std::vector<WayApproach> signs = signs_at(junction.name, give_way);
    if (signs.empty()) continue;
    const auto gives_way = [&](ConnectionId id) {
      const std::string& edge = edge_at(road.connection(id).from);
      const auto made_of = ways.find(edge);
      return made_of != ways.end() &&
             std::any_of(signs.begin(), signs.end(), [&](const WayApproach& sign) {
               return faces(sign, edge, made_of->second);
             });
    };
    const auto is_on_wheels = [&](ConnectionId id) {
      return id != kNoConnection && road.lane(road.connection(id).from).kind == LaneKind::Normal &&
             road.lane(road.connection(id).to).kind == LaneKind::Normal;
    };
    for (std::size_t own = 0; own < junction.requests.size(); ++own) {
      if (!is_on_wheels(junction.links[own]) || !gives_way(junction.links[own])) continue;
      const std::vector<bool>& conflicts = junction.requests[own].conflicts;
      for (std::size_t other = 0; other < conflicts.size(); ++other) {
        if (!conflicts[other] || !is_on_wheels(junction.links[other]) ||
            gives_way(junction.links[other]))
          continue;
        const Connection& first = road.connection(junction.links[other]);
        const Connection& waits = road.connection(junction.links[own]);
        rules.insert(
            {edge_at(first.from), edge_at(first.to), edge_at(waits.from), edge_at(waits.to)});
      }
    }
  }
  return {rules.begin(), rules.end()};
}

}  // namespace sumogamma::osm
