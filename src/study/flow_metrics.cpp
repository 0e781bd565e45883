#include "study/flow_metrics.h"

#include <algorithm>

namespace sumogamma {

namespace {

/// Fills in who is at the head of the chain of agents that wait for one another from `row` on.
void find_head(const WaitGraph& waits, const Scene& scene, std::size_t row, StuckAgent& agent) {
  std::size_t head = row;
  waits.find_ahead(row, [&](std::size_t next) {
    head = next;
    return agent.ring = waits.in_ring(next);
  });
  if (agent.ring || head == row) return;
  const RoadContext& context = scene.context[head];
  agent.head = scene.id[head].value;
  agent.head_reason = context.active ? context.reason : LimitReason::None;
}

/// Does a row wait, over whom it waits for and so on, for somebody who waits for a signal?
bool waits_behind_signal(const WaitGraph& waits, const Scene& scene, std::size_t row) {
  const auto waits_for_signal = [&](std::size_t one) {
    return scene.context[one].active && scene.context[one].reason == LimitReason::Signal;
  };
  return waits_for_signal(row) || waits.find_ahead(row, waits_for_signal) < waits.size();
}

/// What is known of a row at the moment when it becomes stuck, or held.
StuckAgent stuck_agent(const WaitGraph& waits, const Scene& scene, std::size_t row, double since) {
  const RoadContext& context = scene.context[row];
  StuckAgent agent;
  agent.id = scene.id[row];
  agent.type = scene.type[row];
  agent.position = scene.position[row];
  agent.lane = scene.lane[row].lane;
  agent.since = since;
  agent.reason = context.active ? context.reason : LimitReason::None;
  agent.foe = context.active ? context.foe : -1;
  find_head(waits, scene, row, agent);
  return agent;
}

bool at_planned_halt(const Scene& scene, std::size_t row) {
  if (scene.control[row] == Control::Parked || scene.halt[row].left > 0.0) return true;
  return scene.context[row].active && scene.context[row].reason == LimitReason::Stop;
}

}  // namespace

void FlowMonitor::add(const Scene& scene, const AgentTypeTable& types, const RoadState& road,
                      const WaitGraph& waits) {
  by_type_.resize(types.size());
  red_lights_.update(road, scene);
  track_.match(scene.id);
  stuck_now_ = 0;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    State& state = track_[row];
    const AgentType& type = type_of(types, scene.type[row]);
    const double speed = scene.velocity[row].norm();
    Sums& sums = by_type_[static_cast<std::size_t>(kind_of(types, scene.type[row]))];
    sums.speed += speed;
    ++sums.steps;
    const bool vehicle = type.kinematics == Kinematics::SingleTrack;
    if (!state.known && vehicle) ++vehicles_;
    if (state.known) {
      const double moved = (scene.position[row] - state.position).norm();
      // a jump (a teleport of SUMO) is no distance covered
      if (moved <= 2.0 * type.max_speed * step_ + 1.0) distance_ += moved;
    }
    if (vehicle && speed < kWaiting) waiting_ += step_;
    add_stay(waits, scene, row, state);
    state.known = true;
    state.position = scene.position[row];
    const bool in_place = state.stands && (scene.position[row] - state.stopped).norm() < kInPlace;
    if (speed < kStanding || in_place) {
      if (!state.stands) {
        state.stands = true;
        state.stopped = scene.position[row];
        state.stopped_at = scene.time - step_;
      }
      add_standing(waits, scene, row, state);
    } else {
      if (state.record >= 0) stuck_[static_cast<std::size_t>(state.record)].moved_on = true;
      state.record = -1;
      state.standing = 0;
      state.stands = false;
    }
    if (state.record >= 0) ++stuck_now_;
  }
}

void FlowMonitor::add_standing(const WaitGraph& waits, const Scene& scene, std::size_t row,
                               State& state) {
  const bool excused = at_planned_halt(scene, row) || red_lights_.ahead(scene.lane[row].lane) ||
                       waits_behind_signal(waits, scene, row);
  if (!excused) state.standing += step_;
  longest_ = std::max(longest_, state.standing);
  // half a step less: sums of steps don't meet a whole number of seconds exactly
  if (state.record < 0 && state.standing > kStuckTime - 0.5 * step_) {
    state.record = static_cast<std::int32_t>(stuck_.size());
    stuck_.push_back(stuck_agent(waits, scene, row, state.stopped_at));
    if (!state.ever_stuck) ++stuck_agents_;
    state.ever_stuck = true;
  }
  if (state.record >= 0) stuck_[static_cast<std::size_t>(state.record)].standing = state.standing;
}

void FlowMonitor::add_stay(const WaitGraph& waits, const Scene& scene, std::size_t row,
                           State& state) {
  const Vec2& position = scene.position[row];
  if (!state.known || (position - state.stays_at).squaredNorm() > kHeldWithin * kHeldWithin) {
    if (state.held_record >= 0) held_[static_cast<std::size_t>(state.held_record)].moved_on = true;
    state.held_record = -1;
    state.stays_at = position;
    state.stays_since = scene.time;
    state.stays = 0;
    return;
  }
  if (!at_planned_halt(scene, row)) state.stays += step_;
  longest_held_ = std::max(longest_held_, state.stays);
  if (state.held_record < 0 && state.stays > kHeldTime - 0.5 * step_) {
    state.held_record = static_cast<std::int32_t>(held_.size());
    held_.push_back(stuck_agent(waits, scene, row, state.stays_since));
    if (!state.ever_held) ++held_agents_;
    state.ever_held = true;
  }
  if (state.held_record >= 0)
    held_[static_cast<std::size_t>(state.held_record)].standing = state.stays;
}

FlowResult FlowMonitor::result(const AgentTypeTable& types) const {
  FlowResult result;
  double speed = 0;
  std::uint64_t steps = 0;
  for (std::size_t type = 0; type < by_type_.size(); ++type) {
    const Sums& sums = by_type_[type];
    if (sums.steps == 0) continue;
    result.mean_speed_by_type[types[type].name] = sums.speed / static_cast<double>(sums.steps);
    speed += sums.speed;
    steps += sums.steps;
  }
  if (steps > 0) result.mean_speed = speed / static_cast<double>(steps);
  result.distance_km = distance_ / 1000.0;
  result.stuck_agents = stuck_agents_;
  result.longest_standstill_s = longest_;
  result.held_agents = held_agents_;
  result.longest_held_s = longest_held_;
  if (vehicles_ > 0) result.waiting_time_mean_s = waiting_ / static_cast<double>(vehicles_);
  return result;
}

}  // namespace sumogamma
