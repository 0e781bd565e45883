#include "study/rule_metrics.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

void judge(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work) {
  const AgentType& type = type_of(view.types, view.scene.type[row]);
  if (type.kinematics == Kinematics::Holonomic) {
    for (const Judge rule : kOnFoot) rule(view, row, memory, work);
  } else if (view.scene.control[row] != Control::Parked && !type.guided) {
    for (const Judge rule : kOfVehicles) rule(view, row, memory, work);
  }
  memory.known = true;
  memory.position = view.scene.position[row];
  memory.heading = view.scene.heading[row];
}

void add(const RuleCounts& more, RuleCounts& counts) {
  counts.red_light_crossings += more.red_light_crossings;
  counts.signal_crossings += more.signal_crossings;
  counts.red_lights_met += more.red_lights_met;
  counts.mid_block_crossings += more.mid_block_crossings;
  counts.wrong_way_s += more.wrong_way_s;
  counts.overtaking_s += more.overtaking_s;
  counts.off_road_s += more.off_road_s;
  counts.sidewalk_by_vehicle_s += more.sidewalk_by_vehicle_s;
}

}  // namespace

void RuleMonitor::add(const Scene& scene, const AgentTypeTable& types, const RoadState& road,
                      Workers& workers) {
  by_type_.resize(types.size());
  new_events_.clear();
  track_.match(scene.id);
  work_.resize(workers.count());
  const RuleView view{roads_, scene, types, road, before_, step_};
  workers.for_each_range(scene.size(), [&](std::size_t worker, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      State& state = track_[row];
      // after a jump (a teleport of SUMO) nothing was passed
      const double most = 2.0 * type_of(types, scene.type[row]).max_speed * step_ + 1.0;
      if (state.memory.known && (scene.position[row] - state.memory.position).norm() > most)
        state = State{};
      judge(view, row, state.memory, work_[worker]);
    }
  });
  // workers have the rows in order
  at_stop_lines_.clear();
  for (RuleWork& work : work_) {
    for (const Found& found : work.found) gather(scene, types, found);
    at_stop_lines_.insert(at_stop_lines_.end(), work.at_stop_lines.begin(),
                          work.at_stop_lines.end());
    work.found.clear();
    work.at_stop_lines.clear();
  }
  count_red_lights_met(scene, types);
  before_.signal_states = road.signal_states;
}

void RuleMonitor::gather(const Scene& scene, const AgentTypeTable& types, const Found& found) {
  RuleCounts& counts = by_type_[static_cast<std::size_t>(kind_of(types, scene.type[found.row]))];
  switch (found.what) {
    case Finding::SignalPassed:
      ++counts.signal_crossings;
      break;
    case Finding::RedLightMet:
      ++counts.red_lights_met;
      break;
    case Finding::RedLightRun:
      ++counts.red_light_crossings;
      offences_.push_back({Offence::RedLight, scene.id[found.row], scene.type[found.row],
                           found.place, scene.time, 0});
      new_events_.push_back({scene.time, scene.id[found.row], found.place, found.connection});
      break;
    case Finding::RoadCrossed:
      ++counts.mid_block_crossings;
      break;
    case Finding::WrongWay:
      counts.wrong_way_s += step_;
      extend(Offence::WrongWay, scene, found.row);
      break;
    case Finding::Overtaking:
      counts.overtaking_s += step_;
      break;
    case Finding::OffRoad:
      counts.off_road_s += step_;
      extend(Offence::OffRoad, scene, found.row);
      break;
    case Finding::Sidewalk:
      counts.sidewalk_by_vehicle_s += step_;
      extend(Offence::Sidewalk, scene, found.row);
      break;
  }
}

void RuleMonitor::extend(Offence kind, const Scene& scene, std::size_t row) {
  std::int32_t& index = track_[row].span[static_cast<std::size_t>(kind)];
  if (index >= 0) {
    OffenceSpan& span = offences_[static_cast<std::size_t>(index)];
    if (scene.time - span.since - span.duration < kPause) {
      span.duration = scene.time - span.since;
      return;
    }
  }
  index = static_cast<std::int32_t>(offences_.size());
  offences_.push_back(
      {kind, scene.id[row], scene.type[row], scene.position[row], scene.time - step_, step_});
}

/// Those who stand before a red light and have nobody in front of them.
void RuleMonitor::count_red_lights_met(const Scene& scene, const AgentTypeTable& types) {
  const auto by_lane = [](const AtStopLine& a, const AtStopLine& b) { return a.lane < b.lane; };
  at_lines_by_lane_ = at_stop_lines_;
  std::sort(at_lines_by_lane_.begin(), at_lines_by_lane_.end(), by_lane);
  for (const AtStopLine& own : at_stop_lines_) {
    EdgeId& red_met = track_[own.row].memory.stop_line.red_met;
    const EdgeId edge = roads_.network.lane(own.lane).edge;
    if (!own.could_go || red_met == edge) continue;
    const auto [begin, end] =
        std::equal_range(at_lines_by_lane_.begin(), at_lines_by_lane_.end(), own, by_lane);
    const bool held = std::any_of(begin, end, [&](const AtStopLine& other) {
      return other.row != own.row && other.along > own.along &&
             std::abs(other.offset - own.offset) < other.half_width + own.half_width;
    });
    if (held) continue;
    ++by_type_[static_cast<std::size_t>(kind_of(types, scene.type[own.row]))].red_lights_met;
    red_met = edge;
  }
}

RuleResult RuleMonitor::result(const AgentTypeTable& types) const {
  RuleResult result;
  for (std::size_t type = 0; type < by_type_.size(); ++type) {
    if (types[type].variant_of >= 0) continue;
    result.by_type[types[type].name] = by_type_[type];
    sumogamma::add(by_type_[type], result.all);
  }
  return result;
}

}  // namespace sumogamma
