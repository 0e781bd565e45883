#include "scene/scene.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace sumogamma {

namespace {

/// Calls visit(array) for every parallel array: the one list of them.
template <typename SceneType, typename Visit>
void for_each_array(SceneType& scene, Visit&& visit) {
  visit(scene.id);
  visit(scene.type);
  visit(scene.footprint);
  visit(scene.position);
  visit(scene.heading);
  visit(scene.velocity);
  visit(scene.speed);
  visit(scene.steering);
  visit(scene.acceleration);
  visit(scene.preferred_speed);
  visit(scene.behavior);
  visit(scene.manners);
  visit(scene.control);
  visit(scene.path);
  visit(scene.path_along);
  visit(scene.halt);
  visit(scene.held);
  visit(scene.lane);
  visit(scene.height);
  visit(scene.context);
}

}  // namespace

void append_agent(Scene& scene, const AgentState& agent) {
  assert(scene.id.empty() || scene.id.back() < agent.id);
  for_each_array(scene, [](auto& array) { array.emplace_back(); });
  const std::size_t row = scene.size() - 1;
  scene.id[row] = agent.id;
  scene.type[row] = agent.type;
  scene.footprint[row] = agent.footprint;
  scene.position[row] = agent.position;
  scene.heading[row] = agent.heading;
  scene.velocity[row] = agent.speed * direction_of(agent.heading);
  scene.speed[row] = agent.speed;
  scene.acceleration[row] = Vec2::Zero();
  scene.preferred_speed[row] = agent.preferred_speed;
  scene.behavior[row] = agent.behavior;
  scene.manners[row] = agent.manners;
  scene.control[row] = agent.control;
  scene.path[row] = agent.path;
}

void remove_agents(Scene& scene, const std::vector<bool>& removed) {
  assert(removed.size() == scene.size());
  for_each_array(scene, [&](auto& array) {
    std::size_t kept = 0;
    for (std::size_t row = 0; row < array.size(); ++row)
      if (!removed[row]) {
        if (kept != row) array[kept] = std::move(array[row]);
        ++kept;
      }
    array.resize(kept);
  });
}

std::size_t find_row(const Scene& scene, AgentId id) {
  const auto row = std::lower_bound(scene.id.begin(), scene.id.end(), id);
  return row != scene.id.end() && *row == id ? static_cast<std::size_t>(row - scene.id.begin())
                                             : scene.size();
}

std::size_t find_foe(const Scene& scene, std::int64_t id) {
  return id < 0 ? scene.size() : find_row(scene, AgentId{static_cast<std::uint32_t>(id)});
}

std::size_t foe_row(const Scene& scene, std::size_t row) {
  const RoadContext& context = scene.context[row];
  return context.active ? find_foe(scene, context.foe) : scene.size();
}

std::uint64_t hash_state(const Scene& scene, std::uint64_t hash) {
  auto add = [&](std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte)
      hash = fnv1a(hash, static_cast<unsigned char>(bits >> (8 * byte)));
  };
  auto add_double = [&](double value) { add(std::bit_cast<std::uint64_t>(value)); };
  add(static_cast<std::uint64_t>(scene.tick));
  for (std::size_t row = 0; row < scene.size(); ++row) {
    add(scene.id[row].value);
    add_double(scene.position[row].x());
    add_double(scene.position[row].y());
    add_double(scene.heading[row]);
    add_double(scene.velocity[row].x());
    add_double(scene.velocity[row].y());
    add_double(scene.steering[row]);
  }
  return hash;
}

}  // namespace sumogamma
