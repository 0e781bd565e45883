#include "validation/walk_room.h"

#include <algorithm>
#include <cmath>

#include "simulation/open_steps.h"

namespace sumogamma {

namespace {

constexpr double kStep = 0.05;  // [s]

Model model_of(const Room& room, Workers& workers) {
  Model model;
  model.types = {
      type_of(default_agent_types(), find_agent_type(default_agent_types(), "pedestrian"))};
  model.kinematics = build_kinematic_tables(model.types, workers);
  model.options.step = kStep;
  for (const std::vector<Vec2>& wall : room.walls)
    model.road.obstacles.push_back({ObstacleKind::Barrier, wall});
  model.obstacles = ObstacleIndex(model.road.obstacles);
  return model;
}

void add_walker(const Model& model, const Walker& walker, Scene& scene) {
  const AgentType& type = model.types.front();
  AgentState agent;
  agent.id = {static_cast<std::uint32_t>(scene.size())};
  agent.footprint = box_footprint(type.length, type.width);
  agent.position = walker.position;
  agent.preferred_speed = walker.speed;
  agent.behavior.attention = {type.attention_front, type.attention_rear};
  append_agent(scene, agent);
}

/// Where somebody who wants through a gate walks to: past its nearest place, off its ends.
Vec2 goal_behind(const Gate& gate, const Vec2& position) {
  constexpr double kOffEnds = 0.35, kBehind = 1.0;  // [m]
  const Vec2 way = gate.to - gate.from;
  const double length = way.norm(), off = std::min(kOffEnds, 0.5 * length);
  const Vec2 along = way / length;
  const double at = std::clamp(along.dot(position - gate.from), off, length - off);
  const Vec2 nearest = gate.from + at * along;
  const Vec2 right(along.y(), -along.x());
  // straight at it until it is reached, then on through
  return (nearest - position).norm() > kBehind ? nearest : nearest + kBehind * right;
}

bool is_through(const Gate& gate, const Vec2& position) {
  const Vec2 way = gate.to - gate.from, here = position - gate.from;
  return way.x() * here.y() - way.y() * here.x() < 0.0 && way.dot(here) >= 0.0 &&
         way.dot(here) <= way.squaredNorm();
}

/// What everybody wants at a time. People who haven't started stand.
void set_intentions(const Room& room, const std::vector<Walked>& walked, double time,
                    std::size_t walkers, Scene& scene) {
  for (std::size_t row = 0; row < walkers; ++row) {
    const std::size_t who = scene.id[row].value;
    const Walker& walker = room.walkers[who];
    Intention& intention = scene.behavior[row].intention;
    intention.kind = time + 1e-9 < walker.starts_at ? IntentionKind::Stop : IntentionKind::Goal;
    intention.goal = walker.gates.empty() ? Vec2(scene.position[row] + Vec2(50.0, 0.0))
                                          : goal_behind(walker.gates[walked[who].passed.size()],
                                                        scene.position[row]);
  }
}

/// Of a repeated ground: everybody again, a period on or back, whichever is nearer to the ground.
void place_copies(double period, std::size_t walkers, Scene& scene) {
  for (std::size_t row = 0; row < walkers; ++row) {
    const std::size_t copy = walkers + row;
    double& x = scene.position[row].x();
    x -= period * std::floor(x / period);
    scene.position[copy] = scene.position[row] + Vec2(x < 0.5 * period ? period : -period, 0.0);
    scene.heading[copy] = scene.heading[row];
    scene.velocity[copy] = scene.velocity[row];
    scene.acceleration[copy] = scene.acceleration[row];
    scene.speed[copy] = scene.speed[row];
    scene.behavior[copy] = scene.behavior[row];
  }
}

/// Notes who has moved and who went through its gate; who has left is taken out.
std::size_t note_progress(const Room& room, std::size_t walkers, std::vector<Walked>& walked,
                          Scene& scene) {
  constexpr double kWalks = 0.35;  // who stands makes room more slowly [m/s]
  std::vector<bool> left(scene.size(), false);
  for (std::size_t row = 0; row < walkers; ++row) {
    const std::size_t who = scene.id[row].value;
    Walked& of = walked[who];
    if (of.started < 0.0 && scene.velocity[row].norm() > kWalks) of.started = scene.time - kStep;
    const std::vector<Gate>& gates = room.walkers[who].gates;
    if (gates.empty() || !is_through(gates[of.passed.size()], scene.position[row])) continue;
    of.passed.push_back(scene.time);
    left[row] = of.passed.size() == gates.size();
  }
  const auto gone = static_cast<std::size_t>(std::count(left.begin(), left.end(), true));
  if (gone > 0) remove_agents(scene, left);
  return walkers - gone;
}

}  // namespace

std::vector<Walked> walk(const Room& room, double duration, Workers& workers,
                         const RoomObserver& observe) {
  const Model model = model_of(room, workers);
  Scene scene;
  for (const Walker& walker : room.walkers) add_walker(model, walker, scene);
  std::size_t walkers = scene.size();
  if (room.period > 0.0)
    for (const Walker& walker : room.walkers) add_walker(model, walker, scene);
  std::vector<Walked> walked(walkers);
  OpenSteps steps(model, workers);
  const auto count = static_cast<std::size_t>(std::lround(duration / kStep));
  for (std::size_t k = 0; k < count && walkers > 0; ++k) {
    if (room.period > 0.0) place_copies(room.period, walkers, scene);
    set_intentions(room, walked, scene.time, walkers, scene);
    steps.make(walkers, scene);
    if (observe) observe(scene.time, scene, walkers);
    walkers = note_progress(room, walkers, walked, scene);
  }
  return walked;
}

}  // namespace sumogamma
