#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/units.h"
#include "model/model.h"
#include "model/tick_geometry.h"
#include "road/replan.h"
#include "scene/locate.h"
#include "support/plain_net.h"
#include "traffic/junction/occupation.h"
#include "traffic/perception.h"
#include "traffic/road_context.h"
#include "traffic/traffic_view.h"

namespace sumogamma::testing {

/// A network with agents that are put on paths by hand: the model's view of the road without SUMO.
class RoadScene {
 public:
  explicit RoadScene(RoadNetwork network) {
    model.types = default_agent_types();
    model.kinematics = kinematic_tables();
    model.road = std::move(network);
    model.conflicts = build_conflict_table(model.road);
    model.swept_ways = find_swept_ways(model.road, model.conflicts);
    model.options.keep_left = model.road.left_hand;
    road.signal_states.resize(model.road.signals.size());
  }

  /// Somebody of a type whose centre is `along` metres along its path over the named edges.
  std::size_t add(const std::string& type_name, const std::vector<std::string>& edges, double along,
                  double speed, double start = 0, double arrival = -1,
                  const std::string& start_lane = "") {
    const AgentTypeId type = find_agent_type(model.types, type_name);
    const AgentType& row = type_of(model.types, type);
    const std::vector<EdgeId> route = route_of(model.road, edges);
    PathRequest request;
    request.route = route;
    request.vehicle_class = vehicle_class_from_name(row.sumo_class);
    request.start_along = start;
    request.arrival_position = arrival;
    if (!start_lane.empty()) request.start_lane = model.road.lane_by_name.at(start_lane);
    std::string why;
    const bool walks = row.kinematics == Kinematics::Holonomic;
    std::optional<Path> path = walks ? build_walking_path(model.road, request, why)
                                     : build_driving_path(model.road, request, why);
    if (!path) throw std::runtime_error(why);
    return add(type, std::make_shared<const Path>(std::move(*path)), along, speed);
  }

  std::size_t add(AgentTypeId type, std::shared_ptr<const Path> path, double along, double speed) {
    const AgentType& row = type_of(model.types, type);
    AgentState agent;
    agent.id = AgentId{static_cast<std::uint32_t>(scene.size())};
    agent.type = type;
    agent.footprint = box_footprint(row.length, row.width);
    agent.position = path->line.point_at(along);
    agent.heading = heading_of(path->line.direction_at(along));
    agent.speed = speed;
    agent.preferred_speed = row.preferred_speed;
    agent.behavior.intention.kind = IntentionKind::Path;
    agent.path = static_cast<PathId>(road.paths.size());
    road.paths.push_back(std::move(path));
    append_agent(scene, agent);
    scene.path_along.back() = along;
    match_rows(scene, road, traffic);
    return scene.size() - 1;
  }

  /// A place of a row's path moves under it: along [m], to the left of the path [m].
  void move(std::size_t row, double along, double offset = 0) {
    const Polyline& line = path(row).line;
    scene.position[row] = line.point_at(along) + offset * left_of(line.direction_at(along));
    scene.heading[row] = heading_of(line.direction_at(along));
    scene.velocity[row] = scene.speed[row] * line.direction_at(along);
    scene.path_along[row] = along;
  }
  void set_speed(std::size_t row, double speed) {
    scene.speed[row] = speed;
    scene.velocity[row] = speed * direction_of(scene.heading[row]);
  }

  /// The contexts of everybody in the present state, `times` ticks in a row without moving.
  void update(int times = 1, double dt = 0.05) {
    Workers workers;
    for (int k = 0; k < times; ++k) {
      for (std::size_t row = 0; row < scene.size(); ++row)
        locate_on_path(model.road, road, scene, row);
      match_rows(scene, road, traffic);
      prepare_tick(model, scene, workers, geometry);
      update_road_contexts(tick(workers, dt));
    }
  }

  /// Seconds out of `duration` [s] for which a row is held by a reason, while nobody moves.
  double held_for(std::size_t row, LimitReason reason, double duration) {
    constexpr double kStep = 0.5;  // [s]
    double held = 0;
    for (double time = 0; time < duration; time += kStep) {
      update(1, kStep);
      if (context(row).reason == reason) held += kStep;
    }
    return held;
  }

  const Path& path(std::size_t row) const { return *road.path(scene.path[row]); }
  /// What the row's path is made again from, 20 m behind it.
  Replan replan(std::size_t row) const {
    return {model.road, path(row), scene.path_along[row], 20.0};
  }
  const RoadContext& context(std::size_t row) const { return scene.context[row]; }
  /// Everybody is near everybody.
  TrafficView view() const {
    const TrafficView view{model,      road,        scene,  traffic,    geometry.grid,
                           approaches, perception_, waits_, parameters, code};
    waits_.rebuild(scene);
    perception_.resize(scene.size());
    for (std::size_t row = 0; row < scene.size(); ++row)
      perceive(view, row, std::numeric_limits<double>::infinity(), perception_);
    return view;
  }
  TrafficTick tick(Workers& workers, double dt = 0.05) {
    view();
    return {model,   geometry,   workers,     dt,     road,       scene,
            traffic, approaches, perception_, waits_, parameters, code};
  }
  /// Front of a row past a link's stop line [m].
  double past_line(std::size_t row, std::size_t link = 0) const {
    return scene.path_along[row] + half_extent(scene, row, direction_of(scene.heading[row])) -
           path(row).links.at(link).stop_line;
  }

  /// When a row is between two places of its first link [m past its begin].
  Occupation occupation_of(std::size_t row, double begin, double end) const {
    const double length = 2.0 * half_extent(scene, row, direction_of(scene.heading[row]));
    return occupation(view(),
                      {path(row).links.front().connection, static_cast<std::uint32_t>(row),
                       past_line(row), length, scene.speed[row]},
                      begin, end);
  }

  Model model;
  RoadState road;
  Scene scene;
  TrafficState traffic;
  TickGeometry geometry;
  ApproachTable approaches;
  TrafficParameters parameters;
  TrafficCode code;

 private:
  mutable Perception perception_;
  mutable WaitGraph waits_;
  static const std::vector<KinematicTable>& kinematic_tables() {
    static const std::vector<KinematicTable> tables = [] {
      Workers workers;
      return build_kinematic_tables(default_agent_types(), workers);
    }();
    return tables;
  }
};

}  // namespace sumogamma::testing
