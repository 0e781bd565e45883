#include "study/traffic_measures.h"

#include <algorithm>

#include "study/flow_metrics.h"

namespace sumogamma {

EdieFigures edie_figures(const Presence& presence, double length, double area, double duration) {
  EdieFigures figures;
  if (length > 0.0) {
    figures.flow = presence.distance / (length * duration);
    figures.density = presence.time / (length * duration);
  }
  if (area > 0.0) figures.area_density = presence.time / (area * duration);
  if (presence.time > 0.0) figures.speed = presence.distance / presence.time;
  return figures;
}

TrafficMonitor::TrafficMonitor(double step, const RoadNetwork& network, double interval)
    : step_(step), network_(network), interval_(interval) {}

Presence TrafficMonitor::step_of(const Scene& scene, const AgentTypeTable& types,
                                 std::size_t row) const {
  const AgentType& type = type_of(types, scene.type[row]);
  const double speed = scene.velocity[row].norm();
  Presence presence{step_, step_ * speed, speed < FlowMonitor::kWaiting ? step_ : 0.0, 0.0};
  const bool halts = scene.control[row] == Control::Parked || scene.halt[row].left > 0.0;
  const LaneId lane = scene.lane[row].lane;
  if (halts) presence.waiting = 0.0;
  if (halts || lane == kNoLane) return presence;
  const double free = type.kinematics == Kinematics::Holonomic
                          ? type.preferred_speed
                          : std::min(network_.lane(lane).speed_limit, type.max_speed);
  if (free > 0.0) presence.delay = step_ * std::max(0.0, 1.0 - speed / free);
  return presence;
}

void TrafficMonitor::begin_interval(double time) {
  append_lanes(lanes_);
  append_types(types_);
  lane_now_.clear();
  type_now_.clear();
  begin_ = time;
}

void TrafficMonitor::add(const Scene& scene, const AgentTypeTable& types) {
  const double began = scene.time - step_;
  if (!begun_) begin_ = began;
  begun_ = true;
  // a little early: sums of steps don't meet the interval exactly
  if (began >= begin_ + interval_ - 1e-6) begin_interval(begin_ + interval_);
  now_ = scene.time;
  track_.match(scene.id, [&](AgentId id, State& state) {
    left_.push_back({id, state.type, state.entered, began, state.presence});
    ++type_now_[state.type].left;
  });
  for (std::size_t row = 0; row < scene.size(); ++row) {
    State& state = track_[row];
    const AgentTypeId type = kind_of(types, scene.type[row]);
    TypeInterval& of_type = type_now_[type];
    if (!state.known) {
      state = {true, type, began, {}};
      ++of_type.entered;
    }
    const Presence step = step_of(scene, types, row);
    state.presence.add(step);
    of_type.presence.add(step);
    const LaneId lane = scene.lane[row].lane;
    if (lane != kNoLane && scene.control[row] != Control::Parked)
      lane_now_[{static_cast<std::int32_t>(lane), type}].add(step);
  }
}

void TrafficMonitor::append_lanes(std::vector<LaneInterval>& all) const {
  const double end = std::min(begin_ + interval_, now_);
  for (const auto& [place, presence] : lane_now_)
    all.push_back({begin_, end, static_cast<LaneId>(place.first), place.second, presence});
}

void TrafficMonitor::append_types(std::vector<TypeInterval>& all) const {
  const double end = std::min(begin_ + interval_, now_);
  for (const auto& [type, sums] : type_now_)
    all.push_back({begin_, end, type, sums.presence, sums.entered, sums.left});
}

std::vector<LaneInterval> TrafficMonitor::lanes() const {
  std::vector<LaneInterval> all = lanes_;
  append_lanes(all);
  return all;
}

std::vector<TypeInterval> TrafficMonitor::types() const {
  std::vector<TypeInterval> all = types_;
  append_types(all);
  return all;
}

std::vector<AgentJourney> TrafficMonitor::journeys() const {
  std::vector<AgentJourney> all = left_;
  for (std::size_t row = 0; row < track_.ids().size(); ++row) {
    const State& state = track_.states()[row];
    all.push_back({track_.ids()[row], state.type, state.entered, -1.0, state.presence});
  }
  return all;
}

TrafficResult TrafficMonitor::result(const AgentTypeTable& types) const {
  TrafficResult result;
  result.interval = interval_;
  const std::vector<AgentJourney> all = journeys();
  Presence whole;
  std::map<std::string, std::pair<double, double>> of_type;  // agents, way
  for (const AgentJourney& journey : all) {
    whole.add(journey.presence);
    auto& [agents, way] = of_type[type_of(types, journey.type).name];
    ++agents;
    way += journey.presence.distance;
  }
  if (all.empty()) return result;
  const double agents = static_cast<double>(all.size());
  result.delay_mean = whole.delay / agents;
  if (whole.distance > 0.0) result.delay_per_km = whole.delay / (whole.distance / 1000.0);
  for (const auto& [name, sums] : of_type) {
    result.mode_share[name] = sums.first / agents;
    result.distance_share[name] = whole.distance > 0.0 ? sums.second / whole.distance : 0.0;
  }
  return result;
}

}  // namespace sumogamma
