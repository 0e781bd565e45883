#include "realism/scene_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "demand/vehicle_type_xml.h"
#include "realism/map_matching.h"

namespace sumogamma {

namespace {

constexpr const char* kColumns =
    "id,type,x,y,heading_rad,speed,goal_x,goal_y,pref_speed,length,width\n";

/// The speed that 85 % of the agent's own don't exceed [m/s].
double usual_speed(const RecordedAgent& agent) {
  std::vector<double> speeds;
  for (const Vec2& velocity : agent.velocity) speeds.push_back(velocity.norm());
  const auto at =
      speeds.begin() + static_cast<std::ptrdiff_t>(0.85 * static_cast<double>(speeds.size() - 1));
  std::nth_element(speeds.begin(), at, speeds.end());
  return *at;
}

/// A moped is a motorcycle to scenes.
std::string scene_type_of(const RecordedScene& scene, const RecordedAgent& agent) {
  const std::string& name = type_of(scene.types, agent.type).name;
  return name == "moped" ? "motorcycle" : name;
}

std::string scene_row(const RecordedScene& scene, const RecordedAgent& agent,
                      const MotionState& state) {
  const Vec2& goal = agent.position.back();
  return fmt::format("{},{},{:.4f},{:.4f},{:.5f},{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.3f}\n",
                     agent.id, scene_type_of(scene, agent), state.position.x(), state.position.y(),
                     state.heading, state.velocity.norm(), goal.x(), goal.y(), usual_speed(agent),
                     agent.length, agent.width);
}

std::string obstacles_json(const std::vector<Obstacle>& obstacles) {
  nlohmann::ordered_json json;
  for (const Obstacle& obstacle : obstacles) {
    nlohmann::ordered_json outline = nlohmann::ordered_json::array();
    for (const Vec2& corner : obstacle.outline) outline.push_back({corner.x(), corner.y()});
    json["polygons"].push_back({{"vertices_m", outline}});
  }
  return json.dump(1) + "\n";
}

/// Writes SUMO's demand, in order of time.
class RouteFile {
 public:
  explicit RouteFile(const RecordedScene& scene, const RoadNetwork& network)
      : scene_(scene), network_(network) {
    types_ = document_.append_child("routes");
    entries_ = rest_.append_child("routes");
  }

  void add_vehicle(const RecordedAgent& agent, const MatchedRoute& route) {
    const Lane& lane = network_.lane(route.from);
    pugi::xml_node vehicle = entry("vehicle", agent);
    vehicle.append_attribute("departLane") = lane.index;
    vehicle.append_attribute("departPos") =
        fixed(front(lane, route.from_along, agent.length)).c_str();
    vehicle.append_attribute("departSpeed") = fixed(agent.velocity.front().norm()).c_str();
    const Lane& last = network_.lane(network_.edge(route.edges.back()).lanes.front());
    vehicle.append_attribute("arrivalPos") =
        fixed(front(last, route.to_along, agent.length)).c_str();
    vehicle.append_child("route").append_attribute("edges") =
        edge_names(network_, route.edges).c_str();
  }

  void add_person(const RecordedAgent& agent, const MatchedWalk& walk) {
    pugi::xml_node person = entry("person", agent);
    person.append_attribute("departPos") = fixed(walk.from_along).c_str();
    pugi::xml_node stage = person.append_child("walk");
    stage.append_attribute("from") = network_.edge(walk.from).name.c_str();
    stage.append_attribute("to") = network_.edge(walk.to).name.c_str();
    stage.append_attribute("arrivalPos") = fixed(walk.to_along).c_str();
  }

  std::string text() const {
    // SUMO wants a type before its first use
    pugi::xml_document whole;
    whole.reset(document_);
    for (const pugi::xml_node entry : entries_) whole.first_child().append_copy(entry);
    std::ostringstream out;
    whole.save(out, "  ");
    return out.str();
  }

 private:
  /// SUMO's place of a front whose centre is `along` a centreline.
  static double front(const Lane& lane, double along, double length) {
    const double drawn = lane.centerline.length();
    const double scale = drawn > 0 ? lane.length / drawn : 1.0;
    return std::clamp(scale * (along + 0.5 * length), 0.0, lane.length);
  }

  pugi::xml_node entry(const char* element, const RecordedAgent& agent) {
    const std::string type = declared_type(agent);
    pugi::xml_node node = entries_.append_child(element);
    node.append_attribute("id") = std::to_string(agent.id).c_str();
    node.append_attribute("type") = type.c_str();
    node.append_attribute("depart") = fixed(kScoreStep * (agent.first - scene_.first)).c_str();
    return node;
  }

  /// The id of the type of this size, declared where it wasn't yet.
  std::string declared_type(const RecordedAgent& agent) {
    AgentType type = type_of(scene_.types, agent.type);
    if (!agent.default_box) {
      type.length = agent.length;
      type.width = agent.width;
      type.name += fmt::format("_{:.2f}x{:.2f}", agent.length, agent.width);
    }
    if (declared_.insert(type.name).second) append_vehicle_type(types_, type);
    return type.name;
  }

  const RecordedScene& scene_;
  const RoadNetwork& network_;
  pugi::xml_document document_, rest_;
  pugi::xml_node types_, entries_;
  std::set<std::string> declared_;
};

}  // namespace

OpenScene open_scene_of(const RecordedScene& scene, int start) {
  OpenScene open;
  open.start = start;
  open.scene = kColumns;
  open.arrivals = std::string("time_s,") + kColumns;
  std::vector<const RecordedAgent*> later;
  for (const RecordedAgent& agent : scene.agents) {
    if (agent.first > start) later.push_back(&agent);
    if (!agent.present(start)) continue;
    open.scene += scene_row(scene, agent, agent.at(start));
    ++open.present;
  }
  if (open.present == 0)
    throw Error(scene.file, fmt::format("has nobody {:.1f} s after its beginning, expected a time "
                                        "from 0 to {:.1f} with agents; --at",
                                        kScoreStep * (start - scene.first), scene.duration()));
  std::stable_sort(later.begin(), later.end(), [](const RecordedAgent* a, const RecordedAgent* b) {
    return a->first < b->first;
  });
  for (const RecordedAgent* agent : later)
    open.arrivals += fmt::format("{:.1f},", kScoreStep * (agent->first - start)) +
                     scene_row(scene, *agent, agent->at(agent->first));
  open.arriving = later.size();
  if (!scene.obstacles.empty()) open.obstacles = obstacles_json(scene.obstacles);
  return open;
}

std::string edge_names(const RoadNetwork& network, const std::vector<EdgeId>& edges) {
  std::string names;
  for (const EdgeId edge : edges) names += (names.empty() ? "" : " ") + network.edge(edge).name;
  return names;
}

RoadScene road_scene_of(const RecordedScene& scene, const RoadNetwork& network) {
  RoadScene road;
  RouteFile file(scene, network);
  std::vector<const RecordedAgent*> agents;
  for (const RecordedAgent& agent : scene.agents) agents.push_back(&agent);
  // SUMO wants departures in order of time
  std::stable_sort(
      agents.begin(), agents.end(),
      [](const RecordedAgent* a, const RecordedAgent* b) { return a->first < b->first; });
  for (const RecordedAgent* agent : agents) {
    const AgentType& type = type_of(scene.types, agent->type);
    if (type.kinematics == Kinematics::Holonomic) {
      const MatchedWalk walk = match_walk(network, *agent);
      const bool walks = walk.from != kNoEdge;
      if (walks) file.add_person(*agent, walk);
      road.people += walks;
      road.no_sidewalk += !walks;
      continue;
    }
    const MatchedRoute route =
        match_route(network, *agent, vehicle_class_from_name(type.sumo_class));
    const bool off =
        static_cast<double>(route.near) < kLeastOnRoutes * static_cast<double>(route.points);
    // cyclists ride on paths that many maps of roads don't have
    if (type.sumo_class == "bicycle" && off) {
      ++road.beside_lanes;
      continue;
    }
    road.points += route.points;
    road.near += route.near;
    if (off) road.worst.push_back(agent->id);
    road.no_route += route.edges.empty();
    if (route.edges.empty()) continue;
    file.add_vehicle(*agent, route);
    ++road.vehicles;
  }
  road.routes = file.text();
  return road;
}

}  // namespace sumogamma
