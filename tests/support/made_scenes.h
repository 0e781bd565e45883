#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "simulation/scene_file.h"

namespace sumogamma::test {

/// An empty standalone scene over the scene set's types.
inline SceneFile empty_scene(const std::string& name) {
  SceneFile file;
  file.name = name;
  file.types = scene_agent_types(Actuation::CarLike);
  return file;
}

inline void add_agent(SceneFile& file, const char* type_name, const Vec2& position, double heading,
                      const Vec2& goal, double preferred_speed) {
  AgentState agent;
  agent.id = {static_cast<std::uint32_t>(file.scene.size())};
  agent.type = find_agent_type(file.types, type_name);
  const AgentType& type = type_of(file.types, agent.type);
  agent.footprint = box_footprint(type.length, type.width);
  agent.position = position;
  agent.heading = heading;
  agent.preferred_speed = preferred_speed;
  agent.behavior.intention = {IntentionKind::Goal, goal};
  agent.behavior.attention = {type.attention_front, type.attention_rear};
  append_agent(file.scene, agent);
  file.goals.push_back(goal);
}

/// `count` agents on a circle, everybody's goal opposite.
inline SceneFile ring_scene(const char* type_name, int count, double radius,
                            double preferred_speed) {
  SceneFile file = empty_scene("ring");
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * kPi * k / count;
    add_agent(file, type_name, radius * direction_of(angle), wrap_angle(angle + kPi),
              -radius * direction_of(angle), preferred_speed);
  }
  return file;
}

/// Four mixed flows over a square, nobody touching anybody at the start: `area` m^2 an agent.
inline SceneFile mixed_scene(std::uint64_t seed, int count, double area) {
  static const char* const kNames[] = {"People", "People", "Bicycle", "Scooter",
                                       "Car",    "Van",    "Bus"};
  static const double kSpeeds[] = {1.2, 1.2, 2.7, 4.0, 4.0, 4.0, 4.0};
  SceneFile file = empty_scene("mixed");
  const double side = std::sqrt(count * area);
  std::uint64_t draws = 0;
  auto draw = [&](double low, double high) {
    return random_uniform(seed, draws++, 0, Draw::Demand, low, high);
  };
  for (int attempt = 0; static_cast<int>(file.scene.size()) < count && attempt < 100 * count;
       ++attempt) {
    const auto kind = static_cast<std::size_t>(draw(0, 7));
    const Vec2 position{draw(0, side), draw(0, side)};  // braces: x first with every compiler
    const double flow = std::floor(draw(0, 4));
    const double heading = wrap_angle(flow * kPi / 2 + draw(-0.08, 0.08));
    const AgentType& type = type_of(file.types, find_agent_type(file.types, kNames[kind]));
    const double radius = box_footprint(type.length, type.width).radius;
    bool free = true;
    for (std::size_t row = 0; row < file.scene.size() && free; ++row)
      free = (file.scene.position[row] - position).norm() >
             radius + file.scene.footprint[row].radius + 0.05;
    if (free)
      add_agent(file, kNames[kind], position, heading, position + 100 * direction_of(heading),
                kSpeeds[kind] + draw(-0.5, 0.5));
  }
  return file;
}

}  // namespace sumogamma::test
