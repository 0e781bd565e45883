#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "road/sumo_net_reader.h"
#include "road/swept_ways.h"
#include "simulation/simulation.h"

namespace sumogamma::testing {

inline constexpr std::size_t kAgents = 40;  ///< of a RoadTraffic, as tests look at it

/// Traffic on the network of sumo_scenarios/NAME without SUMO: somebody comes onto a lane at random
/// where there is room, drives or walks along a route at random and leaves at its end; the signals
/// show the programs of the file.
class RoadTraffic final : public World {
 public:
  RoadTraffic(const std::string& name, std::uint64_t seed, std::size_t most, std::size_t threads)
      : seed_(seed), most_(most) {
    Model& model = sim.model;
    model.types = default_agent_types();
    sim.workers = std::make_unique<Workers>(threads);
    model.kinematics = build_kinematic_tables(model.types, *sim.workers);
    model.road =
        read_sumo_net(SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/" + name + "/" + name + ".net.xml");
    model.conflicts = build_conflict_table(model.road);
    model.swept_ways = find_swept_ways(model.road, model.conflicts);
    model.options.keep_left = model.road.left_hand;
    sim.road.signal_states.resize(model.road.signals.size());
    sim.road.signal_since.resize(model.road.signals.size());
  }

  void step() { tick(sim, *this); }
  std::size_t arrived() const { return arrived_; }

  void observe(Scene& scene, RoadState& road) override {
    std::vector<bool> leaves(scene.size(), false);
    for (std::size_t row = 0; row < scene.size(); ++row) {
      leaves[row] = scene.path_along[row] > road.path(scene.path[row])->arrival - 1.0;
      if (leaves[row]) ++arrived_;
    }
    remove_agents(scene, leaves);
    constexpr int kTries = 4;
    for (int k = 0; k < kTries && scene.size() < most_; ++k) let_in(scene, road);
    show_signals(scene.time, road);
  }
  void advance(const Scene&) override {}
  bool finished() const override { return false; }

  Simulation sim;

 private:
  std::size_t below(std::size_t count) {
    return random_bits(seed_, draws_++, 0, Draw::Demand) % count;
  }

  /// Edges one after the other, as long as they lead on for the class.
  std::vector<EdgeId> random_route(VehicleClassMask vehicle_class) {
    constexpr std::size_t kLongest = 4;
    const RoadNetwork& network = sim.model.road;
    std::vector<EdgeId> route;
    for (EdgeId edge{static_cast<std::int32_t>(below(network.edges.size()))};
         route.size() < kLongest;) {
      if (network.edge(edge).kind != LaneKind::Normal) break;
      route.push_back(edge);
      std::vector<EdgeId> next;
      for (const LaneId lane : network.edge(edge).lanes)
        for (const ConnectionId id : network.lane(lane).outgoing) {
          const Lane& to = network.lane(network.connection(id).to);
          if ((to.allowed & vehicle_class) != 0 && network.edge(to.edge).kind == LaneKind::Normal)
            next.push_back(to.edge);
        }
      if (next.empty()) break;
      edge = next[below(next.size())];
    }
    return route;
  }

  /// Somebody of a type at random at a place at random, where that is possible.
  void let_in(Scene& scene, RoadState& road) {
    static const char* const kTypes[] = {"car",     "car",        "van",        "truck",
                                         "bicycle", "motorcycle", "pedestrian", "bus"};
    constexpr double kFarthest = 150.0;  // from the lane's end [m]
    constexpr double kRoom = 6.0;        // between bodies, more where somebody comes fast [m]
    const Model& model = sim.model;
    const AgentTypeId type_id = find_agent_type(model.types, kTypes[below(8)]);
    const AgentType& type = type_of(model.types, type_id);
    const bool walks = type.kinematics == Kinematics::Holonomic;
    PathRequest request;
    request.vehicle_class = vehicle_class_from_name(type.sumo_class);
    const std::vector<EdgeId> route = random_route(request.vehicle_class);
    if (route.empty()) return;
    request.route = route;
    const double length = model.road.lane(model.road.edge(route.front()).lanes.front()).length;
    const double back = std::min(kFarthest, length) * 0.01 * static_cast<double>(below(90));
    request.start_along = std::max(0.0, length - back - type.length - kRoom);
    std::string why;
    std::optional<Path> path = walks ? build_walking_path(model.road, request, why)
                                     : build_driving_path(model.road, request, why);
    if (!path || path->line.length() < 10.0) return;
    AgentState agent;
    agent.position = path->line.point_at(0.5 * type.length);
    for (std::size_t row = 0; row < scene.size(); ++row) {
      const double room = 0.5 * type.length + scene.footprint[row].radius + kRoom;
      if ((scene.position[row] - agent.position).norm() < room + 2.0 * scene.speed[row]) return;
    }
    agent.id = AgentId{static_cast<std::uint32_t>(road.paths.size())};
    agent.type = type_id;
    agent.footprint = box_footprint(type.length, type.width);
    agent.heading = heading_of(path->line.direction_at(0.5 * type.length));
    agent.preferred_speed = type.preferred_speed;
    agent.behavior.intention.kind = IntentionKind::Path;
    agent.behavior.attention = {type.attention_front, type.attention_rear};
    agent.path = static_cast<PathId>(road.paths.size());
    road.paths.push_back(std::make_shared<const Path>(std::move(*path)));
    append_agent(scene, agent);
    scene.path_along.back() = 0.5 * type.length;
  }

  void show_signals(double time, RoadState& road) const {
    for (std::size_t k = 0; k < sim.model.road.signals.size(); ++k) {
      const std::vector<SignalPhase>& phases = sim.model.road.signals[k].phases;
      double cycle = 0;
      for (const SignalPhase& phase : phases) cycle += phase.duration;
      double left = std::fmod(time, cycle);
      std::size_t now = 0;
      while (now + 1 < phases.size() && left >= phases[now].duration)
        left -= phases[now++].duration;
      road.signal_states[k] = phases[now].state;
      road.signal_since[k] = time - left;
    }
  }

  std::uint64_t seed_, draws_ = 0;
  std::size_t most_, arrived_ = 0;
};

}  // namespace sumogamma::testing
