#include "simulation/simulation.h"

#include <chrono>

#include "base/cpu_time.h"

namespace sumogamma {

namespace {

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

AdvanceOptions options_of(const Simulation& sim) { return {sim.dt, sim.rules, sim.rules}; }

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

}  // namespace

Advance step_of(Simulation& sim) {
  return {sim.model, *sim.workers, sim.road, sim.scene, sim.traffic, sim.work};
}

void observe(Simulation& sim, World& world) {
  PhaseClock clock;
  world.observe(sim.scene, sim.road);
  clock.end(sim.times.observe);
  const double cpu_before = process_cpu_seconds();
  look_about(step_of(sim), options_of(sim));
  clock.end(sim.times.context);
  sim.times.model_cpu += process_cpu_seconds() - cpu_before;
}

void move_everybody(Simulation& sim) {
  PhaseClock clock;
  const double cpu_before = process_cpu_seconds();
  const Advance step = step_of(sim);
  const AdvanceOptions options = options_of(sim);
  choose_commands(step, options, sim.planned);
  clock.end(sim.times.model);
  sim.times.agent_steps += move_bodies(step, options);
  clock.end(sim.times.track);
  sim.times.model_cpu += process_cpu_seconds() - cpu_before;
}

void tick(Simulation& sim, World& world, const std::function<void()>& record,
          const std::function<void()>& look) {
  observe(sim, world);
  if (look) {
    PhaseClock clock;
    look();
    clock.end(sim.times.record);
  }
  move_everybody(sim);
  advance_and_record(sim, world, record);
}

}  // namespace sumogamma
