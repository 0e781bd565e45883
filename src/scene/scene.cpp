#include "scene/scene.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

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
  visit(scene.path_offset);
  visit(scene.passing_offset);
  visit(scene.lateral_aim);
  visit(scene.overtaking_room);
  visit(scene.merge_to);
  visit(scene.gate);
  visit(scene.blocked_time);
  visit(scene.wedge_left);
  visit(scene.backing_left);
  visit(scene.gives_way_left);
  visit(scene.keeps_clear);
  visit(scene.standing_time);
  visit(scene.stood_at);
  visit(scene.waiting_time);
  visit(scene.halted_for);
  visit(scene.halted_at);
  visit(scene.next_stop);
  visit(scene.stop_left);
  visit(scene.strayed);
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
  scene.path_offset[row] = agent.path_offset;
  scene.passing_offset[row] = agent.path_offset;
  scene.lateral_aim[row] = agent.path_offset;
  scene.merge_to[row] = kNoLane;
  scene.halted_for[row] = kNoConnection;
  scene.gate[row] = std::numeric_limits<double>::infinity();
  scene.stood_at[row] = -std::numeric_limits<double>::infinity();
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

void count_standing(double dt, Kinematics kinematics, Scene& scene, std::size_t row) {
  constexpr double kStands = 0.3, kCreeps = 1.0;  // [m/s]
  constexpr double kCreepsShare = 0.3;            // of the preferred speed: people on foot
  constexpr double kForgets = 10.0;               // of the wait, in a second of getting on [s]
  constexpr double kAll = std::numeric_limits<double>::infinity();
  const double speed = scene.velocity[row].norm();
  const double creeping = std::min(kCreeps, kCreepsShare * scene.preferred_speed[row]);
  // who is pressed back along its way doesn't get on
  const RoadContext& context = scene.context[row];
  const double gets_on = context.active ? scene.velocity[row].dot(context.tangent) : speed;
  scene.standing_time[row] = speed < kStands ? scene.standing_time[row] + dt : 0.0;
  if (speed < kStands) scene.stood_at[row] = scene.time;
  const double forgotten = kinematics == Kinematics::Holonomic ? kForgets * dt : kAll;
  scene.waiting_time[row] = gets_on < creeping ? scene.waiting_time[row] + dt
                                               : std::max(scene.waiting_time[row] - forgotten, 0.0);
}

}  // namespace sumogamma
