#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "model/gamma_velocity.h"
#include "model/tracking.h"

namespace sumogamma::test {

inline double draw(std::uint64_t seed, std::uint64_t k, double low, double high) {
  return random_uniform(seed, k, 0, Draw::Demand, low, high);
}

/// A model without roads over the built-in types.
inline Model open_model(std::size_t threads = 1) {
  Model model;
  model.types = default_agent_types();
  Workers workers(threads);
  model.kinematics = build_kinematic_tables(model.types, workers);
  return model;
}

/// Adds an agent of a named type, heading for a goal.
inline void add_agent(const Model& model, Scene& scene, const char* type_name, const Vec2& position,
                      double heading, double speed, const Vec2& goal, double preferred_speed) {
  AgentState agent;
  agent.id = {static_cast<std::uint32_t>(scene.size())};
  agent.type = find_agent_type(model.types, type_name);
  const AgentType& type = type_of(model.types, agent.type);
  agent.footprint = box_footprint(type.length, type.width);
  agent.position = position;
  agent.heading = heading;
  agent.speed = speed;
  agent.preferred_speed = preferred_speed;
  agent.behavior.intention = {IntentionKind::Goal, goal};
  agent.behavior.attention = {type.attention_front, type.attention_rear};
  append_agent(scene, agent);
}

/// `count` agents of mixed types scattered over a square of the given side, speeds and headings at
/// random. They may overlap.
inline Scene random_scene(const Model& model, std::uint64_t seed, std::size_t count, double side) {
  static const char* const kNames[] = {"pedestrian",  "bicycle", "motorcycle", "car",
                                       "van",         "bus",     "truck",      "electric_tricycle",
                                       "gyro_scooter"};
  Scene scene;
  for (std::size_t k = 0; k < count; ++k) {
    const double heading = draw(seed, 8 * k + 1, -kPi, kPi);
    const double wish = draw(seed, 8 * k + 2, 0.8, 8);
    const Vec2 position(draw(seed, 8 * k + 3, 0, side), draw(seed, 8 * k + 4, 0, side));
    add_agent(model, scene, kNames[random_bits(seed, k, 0, Draw::Demand) % 9], position, heading,
              draw(seed, 8 * k + 5, 0, wish),
              position + 50 * direction_of(heading + draw(seed, 8 * k + 6, -0.5, 0.5)), wish);
  }
  return scene;
}

/// v_new of every row.
inline std::vector<Vec2> all_velocities(const Model& model, const Scene& scene) {
  Workers workers(1);
  TickGeometry geometry;
  prepare_tick(model, scene, workers, geometry);
  Workspace work;
  std::vector<Vec2> velocities;
  for (std::size_t row = 0; row < scene.size(); ++row)
    velocities.push_back(gamma_velocity(model, scene, geometry, row, scene.behavior[row], work));
  return velocities;
}

/// One tick of everybody, from the frozen scene.
inline void step(const Model& model, Scene& scene, double dt) {
  const std::vector<Vec2> velocities = all_velocities(model, scene);
  std::vector<BodyState> next;
  for (std::size_t row = 0; row < scene.size(); ++row)
    next.push_back(track_velocity(model, scene, row, velocities[row], dt));
  for (std::size_t row = 0; row < scene.size(); ++row) place_body(next[row], scene, row);
  ++scene.tick;
  scene.time += dt;
}

/// True where two rows' bare outlines overlap.
inline bool overlap(const Scene& scene, std::size_t a, std::size_t b) {
  return overlap_depth(place_polygon(scene.footprint[a].outline(), direction_of(scene.heading[a])),
                       place_polygon(scene.footprint[b].outline(), direction_of(scene.heading[b])),
                       scene.position[b] - scene.position[a]) > 1e-6;
}

}  // namespace sumogamma::test
