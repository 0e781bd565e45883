#include "osm/network_facts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <sstream>

#include "osm/lane_overlap.h"
#include "osm/network_file.h"
#include "road/sumo_net_reader.h"

namespace sumogamma::osm {
namespace {

/// Groups of junctions joined by edges that the mask may use.
int count_components(const RoadNetwork& road, VehicleClassMask mask) {
  std::vector<std::size_t> group(road.junctions.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  auto find = [&](std::size_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  std::set<std::size_t> used;
  for (const Edge& edge : road.edges) {
    if (edge.kind != LaneKind::Normal) continue;
    if (!allows(road, edge, mask) || edge.from == kNoJunction || edge.to == kNoJunction) continue;
    group[find(index_of(edge.from))] = find(index_of(edge.to));
    used.insert(index_of(edge.from));
  }
  std::set<std::size_t> roots;
  for (const std::size_t junction : used) roots.insert(find(junction));
  return static_cast<int>(roots.size());
}

}  // namespace

std::map<std::string, double> network_facts(const RoadNetwork& road) {
  std::map<std::string, double> facts;
  for (const char* name :
       {"edges", "lanes", "car_edges", "car_edges_with_sidewalk", "crossings", "walking_areas",
        "roundabout_junctions", "lanes_under_1_m", "kilometres"})
    facts[name] = 0;
  for (const Edge& edge : road.edges) {
    if (edge.kind == LaneKind::Crossing) ++facts["crossings"];
    if (edge.kind == LaneKind::WalkingArea) ++facts["walking_areas"];
    if (edge.kind != LaneKind::Normal) continue;
    ++facts["edges"];
    bool cars = false, sidewalk = false;
    for (const LaneId id : edge.lanes) {
      const Lane& lane = road.lane(id);
      ++facts["lanes"];
      facts["lanes_under_1_m"] += lane.centerline.length() < 1.0;
      facts["kilometres"] += id == edge.lanes[0] ? lane.centerline.length() / 1000.0 : 0.0;
      cars = cars || (lane.allowed & vehicle_class::kPassenger) != 0;
      sidewalk = sidewalk || lane.allowed == vehicle_class::kPedestrian;
    }
    facts["car_edges"] += cars;
    facts["car_edges_with_sidewalk"] += cars && sidewalk;
  }
  facts["junctions"] =
      static_cast<double>(std::count_if(road.junctions.begin(), road.junctions.end(),
                                        [](const Junction& j) { return j.type != "internal"; }));
  for (const Junction& junction : road.junctions)
    facts["roundabout_junctions"] += junction.in_roundabout;
  facts["signals"] = static_cast<double>(road.signals.size());
  facts["connections"] = static_cast<double>(road.connections.size());
  facts["car_components"] = count_components(road, vehicle_class::kPassenger);
  const OverlapLength overlaps = overlap_length(road, find_lane_overlaps(road));
  facts["overlapping_lanes_m"] = std::round(overlaps.wheels);
  facts["overlapping_walkways_m"] = std::round(overlaps.walking);
  facts["walk_components"] = count_components(road, vehicle_class::kPedestrian);
  return facts;
}

std::vector<std::vector<std::string>> unmarked_roundabouts(const pugi::xml_node& net,
                                                           const OsmMap& map) {
  std::set<std::int64_t> ways;
  for (const MapWay& way : map.ways)
    if (tag_is(way.tags, "junction", {"roundabout"})) ways.insert(way.id);
  const auto origins = ways_of_edges(net);

  std::set<std::string> marked;
  for (const pugi::xml_node ring : net.children("roundabout")) {
    std::istringstream edges(ring.attribute("edges").value());
    for (std::string edge; edges >> edge;) marked.insert(edge);
  }
  struct RingEdge {
    std::string id, to;
  };
  std::map<std::string, RingEdge> by_start;
  for (const pugi::xml_node edge : net.children("edge")) {
    if (edge.attribute("function")) continue;
    const auto& made_of = origins.at(edge.attribute("id").value());
    const bool on_ring = std::any_of(made_of.begin(), made_of.end(),
                                     [&](std::int64_t way) { return ways.contains(way); });
    if (on_ring)
      by_start[edge.attribute("from").value()] = {edge.attribute("id").value(),
                                                  edge.attribute("to").value()};
  }
  std::vector<std::vector<std::string>> rings;
  std::set<std::string> done;
  for (const auto& [start, edge] : by_start) {
    if (done.contains(start)) continue;
    std::vector<std::string> ring;
    bool known = false;
    std::string at = start;
    while (by_start.contains(at) && done.insert(at).second) {
      ring.push_back(by_start.at(at).id);
      known = known || marked.contains(ring.back());
      at = by_start.at(at).to;
    }
    if (at == start && ring.size() >= 2 && !known) rings.push_back(ring);
  }
  return rings;
}

}  // namespace sumogamma::osm
