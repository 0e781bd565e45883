#include "study/smoothness_metrics.h"

#include <cmath>

#include "base/units.h"

namespace sumogamma {

void SmoothnessMonitor::add(const Scene& scene, const AgentTypeTable& types) {
  by_type_.resize(types.size());
  track_.match(scene.id);
  for (std::size_t row = 0; row < scene.size(); ++row)
    add_agent(scene, row, type_of(types, scene.type[row]),
              by_type_[static_cast<std::size_t>(kind_of(types, scene.type[row]))]);
}

void SmoothnessMonitor::add_agent(const Scene& scene, std::size_t row, const AgentType& type,
                                  Counts& counts) {
  State& state = track_[row];
  const Vec2 moved = scene.position[row] - state.position;
  const double turn = wrap_angle(scene.heading[row] - state.heading);
  // twice what the type can do in a step, and a metre for slow ones, is a jump
  if (state.ticks > 0 && moved.norm() > 2.0 * type.max_speed * step_ + 1.0) state = State{};

  const Vec2 forward = direction_of(state.heading + 0.5 * turn);
  const bool wheeled = type.kinematics == Kinematics::SingleTrack;
  const double axle = wheeled ? type.rear_axle_to_center : 0.0;
  // displacement of the rear axle: the centre's own sideways motion in a turn is no slip
  const Vec2 axle_moved =
      moved - axle * (direction_of(scene.heading[row]) - direction_of(state.heading));
  const double along = axle_moved.dot(forward) / step_;
  const double speed = wheeled ? along : moved.norm() / step_;
  State next;
  next.ticks = std::min(state.ticks + 1, 3);
  next.position = scene.position[row];
  next.heading = scene.heading[row];
  next.speed = state.ticks > 0 ? speed : 0.0;
  next.backward = state.backward;
  if (state.ticks >= 1) {
    const bool moving = std::abs(speed) > kMoving || std::abs(state.speed) > kMoving;
    if (along < -kBackward && !state.backward) {
      ++counts.reversals;
      if (wheeled) ++wheeled_.reversals;
      next.backward = true;
    } else if (along > kBackward) {
      next.backward = false;
    }
    auto add_to = [&](Counts& into) {
      ++into.agent_steps;
      into.yaw_rate.add(std::abs(turn) / step_);
      if (wheeled) into.slip.add(std::abs(cross(forward, axle_moved)) / step_);
      if (state.ticks >= 2) into.acceleration.add(std::abs(speed - state.speed) / step_);
      if (state.ticks >= 3)
        into.jerk.add(std::abs((speed - state.speed) / step_ - state.acceleration) / step_);
    };
    if (moving) {
      add_to(counts);
      if (wheeled) add_to(wheeled_);
    }
  }
  next.acceleration = state.ticks >= 2 ? (speed - state.speed) / step_ : 0.0;
  state = next;
}

SmoothnessValues SmoothnessMonitor::Counts::values() const {
  constexpr double kShare = 0.95;
  return {acceleration.quantile(kShare),
          jerk.quantile(kShare),
          yaw_rate.quantile(kShare),
          slip.quantile(kShare),
          reversals,
          agent_steps};
}

SmoothnessResult SmoothnessMonitor::result(const AgentTypeTable& types) const {
  SmoothnessResult result;
  result.wheeled = wheeled_.values();
  for (std::size_t type = 0; type < by_type_.size(); ++type)
    if (by_type_[type].agent_steps > 0) result.by_type[types[type].name] = by_type_[type].values();
  return result;
}

}  // namespace sumogamma
