#include "simulation/simulation.h"

#include <chrono>
#include <ctime>

#include "scene/extent.h"
#include "traffic/recovery/reversing.h"

namespace sumogamma {

namespace {

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Adds the wall time since its last call to a phase.
class PhaseClock {
 public:
  void end(double& phase) {
    const auto now = std::chrono::steady_clock::now();
    phase += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Planned halts: stands out a stop's time once the front is there, or once it stands behind
/// another that halts where there is room for both, then looks to the next one.
void update_halt(const Path& path, double dt, Scene& scene, std::size_t row) {
  constexpr double kThere = 0.4;   // SUMO counts a stop as reached half a metre before it [m]
  constexpr double kPassed = 5.0;  // [m]
  const auto next = static_cast<std::size_t>(scene.halt[row].next);
  if (next >= path.stops.size()) return;
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
  const PathStop& stop = path.stops[next];
  const std::size_t foe = foe_row(scene, row);
  const bool behind_another = foe < scene.size() && scene.halt[foe].left > 0.0;
  const double there = stop.along - (behind_another ? std::max(stop.room, kThere) : kThere);
  if (front > stop.along + kPassed)
    ++scene.halt[row].next;  // passed: it began beyond its stop
  else if (front > there && scene.speed[row] < 0.2)
    scene.halt[row].left = std::max(stop.duration, dt);
}

void apply(const BodyState& next, double dt, Scene& scene, std::size_t row) {
  scene.acceleration[row] = (next.velocity - scene.velocity[row]) / dt;
  place_body(next, scene, row);
}

/// SUMO computes in a process of its own, for which we would only wait.
void advance_and_record(Simulation& sim, World& world, const std::function<void()>& record) {
  PhaseClock clock;
  if (sim.workers->count() == 1 || !record) {
    world.advance(sim.scene);
    clock.end(sim.times.advance);
    if (record) record();
  } else {
    if (!sim.recording) sim.recording = std::make_unique<Workers>(2);
    sim.recording->for_each_range(2, [&](std::size_t, std::size_t job, std::size_t) {
      if (job == 1) return record();
      world.advance(sim.scene);  // by the calling thread, as ever
      clock.end(sim.times.advance);
    });
  }
  clock.end(sim.times.record);
}

TrafficTick traffic_tick(Simulation& sim) {
  return {sim.model,
          sim.geometry,
          *sim.workers,
          sim.dt,
          sim.road,
          sim.scene,
          sim.traffic.state,
          sim.traffic.approaches,
          sim.traffic.perception,
          sim.traffic.waits,
          sim.traffic.parameters,
          sim.traffic.code};
}

}  // namespace

void observe(Simulation& sim, World& world) {
  PhaseClock clock;
  world.observe(sim.scene, sim.road);
  clock.end(sim.times.observe);
  const double cpu_before = cpu_seconds();
  update_traffic(traffic_tick(sim), sim.traffic);
  clock.end(sim.times.context);
  sim.times.model_cpu += cpu_seconds() - cpu_before;
}

void move_everybody(Simulation& sim) {
  PhaseClock clock;
  const double cpu_before = cpu_seconds();
  Scene& scene = sim.scene;
  const std::size_t rows = scene.size();
  sim.workspaces.resize(sim.workers->count());
  sim.commands.resize(rows);
  const TrafficTick traffic = traffic_tick(sim);

  // everyone reads the same frozen scene and writes only its own command
  const TrafficView view = traffic.view();
  sim.workers->for_each_range(rows, [&](std::size_t worker, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      if (scene.control[row] != Control::Gamma) continue;
      if (const auto backed = back_out(view, sim.geometry, row, sim.dt)) {
        sim.commands[row] = *backed;
        continue;
      }
      const Vec2 velocity = gamma_velocity(sim.model, scene, sim.geometry, row, scene.behavior[row],
                                           sim.workspaces[worker]);
      sim.commands[row] =
          next_body(sim.model, scene, row, velocity, sim.dt, sim.workspaces[worker]);
    }
  });
  clock.end(sim.times.model);

  for (std::size_t row = 0; row < rows; ++row) {
    if (scene.control[row] != Control::Gamma) continue;
    if (const Path* path = sim.road.path(scene.path[row])) update_halt(*path, sim.dt, scene, row);
    apply(sim.commands[row], sim.dt, scene, row);
    ++sim.times.agent_steps;
  }
  remember_tick(traffic, sim.traffic);
  ++scene.tick;
  scene.time += sim.dt;
  clock.end(sim.times.track);
  sim.times.model_cpu += cpu_seconds() - cpu_before;
}

void tick(Simulation& sim, World& world, const std::function<void()>& record) {
  observe(sim, world);
  move_everybody(sim);
  advance_and_record(sim, world, record);
}

}  // namespace sumogamma
