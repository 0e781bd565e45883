#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/random.h"
#include "road/road_network.h"
#include "scene/agent_type.h"
#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma::testing {

/// Boxes that slide along the lanes of a network at constant speed, each from lane to lane by a
/// random link, stopping at red lights: enough motion to try monitors and outputs on, without a
/// model or SUMO.
class SyntheticTraffic {
 public:
  SyntheticTraffic(const RoadNetwork& network, std::size_t count, double step,
                   std::uint64_t seed = 1)
      : network_(network), step_(step), seed_(seed) {
    road.signal_states.resize(network.signals.size());
    std::vector<LaneId> starts;
    for (std::size_t i = 0; i < network.lanes.size(); ++i)
      if (network.lanes[i].kind == LaneKind::Normal && network.lanes[i].centerline.length() > 15)
        starts.push_back(LaneId(static_cast<int>(i)));
    for (std::size_t i = 0; i < count; ++i) {
      const LaneId lane = starts[random_bits(seed, i, 0, Draw::Demand) % starts.size()];
      add_agent(i, lane);
    }
    update_signals();
  }

  /// Next tick.
  void advance() {
    ++scene.tick;
    scene.time = static_cast<double>(scene.tick) * step_;
    update_signals();
    std::vector<bool> removed(scene.size(), false);
    for (std::size_t row = 0; row < scene.size(); ++row) removed[row] = !move(row);
    std::size_t kept = 0;
    for (std::size_t row = 0; row < removed.size(); ++row)
      if (!removed[row]) plans_[kept++] = plans_[row];
    plans_.resize(kept);
    remove_agents(scene, removed);
  }

  static std::string name_of(AgentId id) { return "agent" + std::to_string(id.value); }

  Scene scene;
  RoadState road;
  AgentTypeTable types = default_agent_types();

 private:
  struct Plan {
    LaneId lane;
    double along, speed;
  };

  void add_agent(std::size_t index, LaneId lane_id) {
    static constexpr const char* kOnRoads[] = {"car", "car",   "car",        "van",
                                               "bus", "truck", "motorcycle", "bicycle"};
    const Lane& lane = network_.lane(lane_id);
    const bool walks =
        (lane.allowed & vehicle_class::kPedestrian) && lane.allowed != vehicle_class::kAll;
    AgentState agent;
    agent.id = AgentId{static_cast<std::uint32_t>(index)};
    agent.type = find_agent_type(
        types, walks ? "pedestrian" : kOnRoads[random_bits(seed_, index, 1, Draw::Demand) % 8]);
    const AgentType& type = type_of(types, agent.type);
    agent.footprint = box_footprint(type.length, type.width);
    agent.control = index % 5 == 4 ? Control::External : Control::Gamma;
    append_agent(scene, agent);
    const double along =
        random_uniform(seed_, index, 2, Draw::Demand, 0.1, 0.9) * lane.centerline.length();
    plans_.push_back(
        {lane_id, along,
         std::min(type.preferred_speed, lane.speed_limit > 0 ? lane.speed_limit : 10.0)});
    place(scene.size() - 1, 0);
  }

  void update_signals() {
    for (std::size_t i = 0; i < road.signal_states.size(); ++i) {
      // one link after the other: 8 s green, 2 s amber
      std::string state(network_.signals[i].size, 'r');
      const auto phase = static_cast<std::size_t>(scene.time / 10.0);
      for (std::size_t link = phase % 2; link < state.size(); link += 2)
        state[link] = std::fmod(scene.time, 10.0) < 8.0 ? 'G' : 'y';
      road.signal_states[i] = state;
    }
  }

  /// Red at the end of the lane for every way on.
  bool held(const Plan& plan) const {
    const Lane& lane = network_.lane(plan.lane);
    if (lane.centerline.length() - plan.along > 6.0) return false;
    bool any = false;
    for (const ConnectionId id : lane.outgoing) {
      const Light shown = road.signal(network_.connection(id));
      any = any || is_red(shown) || is_amber(shown);
      if (shown == Light::GreenFirst || shown == Light::None) return false;
    }
    return any;
  }

  bool move(std::size_t row) {
    Plan& plan = plans_[row];
    const double speed = held(plan) ? 0.0 : plan.speed;
    plan.along += speed * step_;
    while (plan.along > network_.lane(plan.lane).centerline.length()) {
      const Lane& lane = network_.lane(plan.lane);
      if (lane.outgoing.empty()) return false;
      plan.along -= lane.centerline.length();
      const std::size_t choice = random_bits(
          seed_, scene.id[row].value, static_cast<std::uint64_t>(scene.tick), Draw::Intention);
      const Connection& link = network_.connection(lane.outgoing[choice % lane.outgoing.size()]);
      plan.lane = link.via != kNoLane ? link.via : link.to;
      if (network_.lane(plan.lane).kind == LaneKind::WalkingArea) plan.along = 1e-3;
    }
    place(row, speed);
    return true;
  }

  void place(std::size_t row, double speed) {
    const Plan& plan = plans_[row];
    const Polyline& line = network_.lane(plan.lane).centerline;
    const Vec2 direction = line.direction_at(plan.along);
    scene.position[row] = line.point_at(plan.along);
    scene.heading[row] = heading_of(direction);
    scene.velocity[row] = speed * direction;
    scene.speed[row] = speed;
    scene.lane[row] = {plan.lane, plan.along, 0.0};
    scene.context[row].active = scene.control[row] == Control::Gamma;
    scene.context[row].reason = speed == 0.0 ? LimitReason::Signal : LimitReason::None;
  }

  const RoadNetwork& network_;
  double step_;
  std::uint64_t seed_;
  std::vector<Plan> plans_;
};

}  // namespace sumogamma::testing
