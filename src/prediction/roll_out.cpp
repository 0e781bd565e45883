#include "prediction/roll_out.h"

#include "inference/behavior_filter.h"

namespace sumogamma {

namespace {

// slower than this a direction of motion is noise [m/s]
constexpr double kMoving = 0.1;

/// Velocity of the centre that brings the reference point to `target` [m/s].
Vec2 velocity_towards(const AgentType& type, const Scene& scene, std::size_t row,
                      const Vec2& target, double period) {
  const Vec2 forward = direction_of(scene.heading[row]);
  const Vec2 reference = scene.position[row] - type.rear_axle_to_center * forward;
  const Vec2 rear = (target - reference) / period;
  if (type.rear_axle_to_center == 0) return rear;
  // the rear axle arrives along its chord: the body will have turned by twice the chord's angle
  const double speed = rear.norm();
  if (speed < kMoving) return rear;
  const Vec2 chord = rear / speed;
  const double sine = cross(forward, chord), cosine = forward.dot(chord);
  const Vec2 ahead = cosine > 0 ? Vec2(chord * cosine + left_of(chord) * sine) : forward;
  return rear + (type.rear_axle_to_center / period) * (ahead - forward);
}

/// Moves a row exactly as asked; wheels point along the way of the rear axle.
BodyState move_as_asked(const AgentType& type, const BodyState& body, const Vec2& velocity,
                        double period) {
  BodyState next = body;
  next.velocity = velocity;
  next.position = body.position + period * velocity;
  if (velocity.norm() > kMoving) {
    const Vec2 reference = body.position - type.rear_axle_to_center * direction_of(body.heading);
    const Vec2 ahead = next.position - reference;
    next.heading = heading_of(type.rear_axle_to_center > 0 ? ahead : velocity);
  }
  next.speed = velocity.norm();
  return next;
}

void move(const std::vector<BodyState>& next, double period, Scene& scene) {
  for (std::size_t row = 0; row < next.size(); ++row) place_body(next[row], scene, row);
  scene.tick += 1;
  scene.time += period;
}

}  // namespace

void build_scene(const AgentTypeTable& types, const ObservedScene& seen,
                 std::span<const Vec2> velocity, Scene& scene) {
  // emptied, not made anew: its arrays keep their room
  remove_agents(scene, std::vector<bool>(scene.size(), true));
  scene.time = 0;
  scene.tick = 0;
  for (std::size_t row = 0; row < seen.agents.size(); ++row) {
    const ObservedAgent& agent = seen.agents[row];
    const AgentType& type = type_of(types, agent.type);
    AgentState state;
    state.id = {agent.id};
    state.type = agent.type;
    state.footprint = box_footprint(type.length, type.width);
    state.heading = agent.heading.back();
    state.position = agent.now() + type.rear_axle_to_center * direction_of(state.heading);
    state.preferred_speed = velocity[row].norm();
    state.speed = state.preferred_speed;
    state.behavior.attention = {type.attention_front, type.attention_rear};
    append_agent(scene, state);
    scene.velocity[row] = velocity[row];
  }
}

void RollOut::run(const Model& model, const RollOutOptions& options, double period,
                  std::span<const Vec2> path, std::size_t steps, Scene& scene, Forecast& forecast) {
  const std::size_t rows = scene.size();
  forecast.resize(rows, steps);
  next_.resize(rows);
  for (std::size_t k = 0; k < steps; ++k) {
    for (std::size_t row = 0; row < rows; ++row) {
      const AgentType& type = type_of(model.types, scene.type[row]);
      const std::size_t at = row * steps + k;
      Vec2 target = path[at];
      if (k > 0) {
        // what a detour left behind is made good in part
        const Vec2 detour = path[at - 1] - forecast.position[at - 1];
        target -= (1.0 - options.rejoin) * detour;
      }
      set_wanted_velocity(scene, row, velocity_towards(type, scene, row, target, period));
    }
    prepare_tick(model, scene, workers_, geometry_);
    for (std::size_t row = 0; row < rows; ++row) {
      const Vec2 velocity =
          gamma_velocity(model, scene, geometry_, row, scene.behavior[row], work_);
      const AgentType& type = type_of(model.types, scene.type[row]);
      next_[row] = options.use_bodies ? track_velocity(model, scene, row, velocity, period)
                                      : move_as_asked(type, body_of(scene, row), velocity, period);
    }
    move(next_, period, scene);
    for (std::size_t row = 0; row < rows; ++row) {
      const AgentType& type = type_of(model.types, scene.type[row]);
      const std::size_t at = row * steps + k;
      forecast.heading[at] = scene.heading[row];
      forecast.position[at] =
          scene.position[row] - type.rear_axle_to_center * direction_of(scene.heading[row]);
    }
  }
}

}  // namespace sumogamma
