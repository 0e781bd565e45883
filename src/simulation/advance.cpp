#include "simulation/advance.h"

#include "scene/extent.h"
#include "scene/locate.h"
#include "traffic/recovery/reversing.h"

namespace sumogamma {

namespace {

TrafficTick traffic_tick(const Advance& world, const AdvanceOptions& options) {
  Traffic& traffic = world.traffic;
  return {world.model,        world.work.geometry, world.workers,      options.dt,
          world.road,         world.scene,         traffic.state,      traffic.approaches,
          traffic.perception, traffic.waits,       traffic.parameters, traffic.code,
          options.rules,      options.lanes};
}

/// Planned halts: stands out a stop's time once the front is there, or once it stands behind
/// another that halts where there is room for both, then looks to the next one.
void update_halt(const Path& path, double dt, Scene& scene, std::size_t row) {
  constexpr double kThere = 0.4;   // SUMO counts a stop as reached half a metre before it [m]
  constexpr double kPassed = 5.0;  // [m]
  const PathStop* stop = next_stop(path, scene, row);
  if (stop == nullptr) return;
  if (scene.halt[row].left > 0.0) {
    scene.halt[row].left -= dt;
    if (scene.halt[row].left <= 0.0) {
      scene.halt[row].left = 0.0;
      ++scene.halt[row].next;
    }
    return;
  }
  const double front = scene.path_along[row] +
                       half_extent(scene, row, path.line.direction_at(scene.path_along[row]));
  const std::size_t foe = foe_row(scene, row);
  const bool behind_another = foe < scene.size() && scene.halt[foe].left > 0.0;
  const double there = stop->along - (behind_another ? std::max(stop->room, kThere) : kThere);
  if (front > stop->along + kPassed)
    ++scene.halt[row].next;  // passed: it began beyond its stop
  else if (front > there && scene.speed[row] < 0.2)
    scene.halt[row].left = std::max(stop->duration, dt);
}

void apply(const BodyState& next, double dt, Scene& scene, std::size_t row) {
  scene.acceleration[row] = (next.velocity - scene.velocity[row]) / dt;
  place_body(next, scene, row);
}

}  // namespace

void look_about(const Advance& world, const AdvanceOptions& options) {
  update_traffic(traffic_tick(world, options), world.traffic);
}

void choose_commands(const Advance& world, const AdvanceOptions& options,
                     const PlannedVelocity& planned) {
  const Scene& scene = world.scene;
  AdvanceWork& work = world.work;
  const std::size_t rows = scene.size();
  work.workspaces.resize(world.workers.count());
  work.commands.resize(rows);
  work.bindings.assign(rows, Binding{});
  const TrafficView view = traffic_tick(world, options).view();
  for (std::size_t row = 0; row < rows; ++row) {
    if (scene.control[row] != Control::Planned) continue;
    const Vec2 wish = planned ? planned(view, row) : Vec2(Vec2::Zero());
    work.commands[row] = track_velocity(world.model, scene, row, wish, options.dt);
  }
  // everyone reads the same frozen scene and writes only its own command
  world.workers.for_each_range(rows, [&](std::size_t worker, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      if (scene.control[row] != Control::Gamma) continue;
      if (const auto backed = back_out(view, work.geometry, row, options.dt)) {
        work.commands[row] = *backed;
        work.bindings[row] = {BindingKind::BackingOut, -1};
        continue;
      }
      const Vec2 velocity = gamma_velocity(world.model, scene, work.geometry, row,
                                           scene.behavior[row], work.workspaces[worker]);
      work.bindings[row] = binding_of(scene, row, velocity, work.workspaces[worker]);
      work.commands[row] =
          next_body(world.model, scene, row, velocity, options.dt, work.workspaces[worker]);
    }
  });
}

std::int64_t move_bodies(const Advance& world, const AdvanceOptions& options) {
  Scene& scene = world.scene;
  std::int64_t moved = 0;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (!is_ours(scene.control[row])) continue;
    // a planner's vehicle halts where its planner means to
    const Path* path = world.road.path(scene.path[row]);
    if (path != nullptr && scene.control[row] == Control::Gamma)
      update_halt(*path, options.dt, scene, row);
    apply(world.work.commands[row], options.dt, scene, row);
    ++moved;
  }
  remember_tick(traffic_tick(world, options), world.traffic);
  ++scene.tick;
  scene.time += options.dt;
  return moved;
}

void advance_rows(const Advance& world, const AdvanceOptions& options,
                  const PlannedVelocity& planned) {
  look_about(world, options);
  choose_commands(world, options, planned);
  move_bodies(world, options);
}

}  // namespace sumogamma
