#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "simulation/advance.h"
#include "simulation/world.h"

namespace sumogamma {

/// Wall time spent in the phases of the ticks so far [s]; of recording, what it took longer than
/// the world's step where both ran at once.
struct PhaseTimes {
  double observe = 0, context = 0, model = 0, track = 0, advance = 0, record = 0;
  double model_cpu = 0;          ///< CPU time of context, model and track, all threads [s]
  std::int64_t agent_steps = 0;  ///< rows moved by the model
};

/// A run: everything that a tick reads and writes.
struct Simulation {
  Model model;
  RoadState road;
  Scene scene;
  double dt = 0.05;   ///< [s]
  bool rules = true;  ///< of the road, lane choice among them; see AdvanceOptions
  std::unique_ptr<Workers> workers = std::make_unique<Workers>(1);
  std::unique_ptr<Workers> recording;  ///< two: the world's step and what is recorded meanwhile
  PhaseTimes times;
  Traffic traffic;
  PlannedVelocity planned;  ///< of the ego, where there is one
  AdvanceWork work;         ///< scratch, meaning nothing between ticks
};

/// What a step of a run reads and writes.
Advance step_of(Simulation& simulation);

/// Advances everybody by dt: observe, put the road's view of each agent together, choose velocities
/// from the frozen scene (Eq. 7), track them with the bodies' controllers, and hand the result to
/// the world. `record` is called once for the new state; with more than one worker it runs while
/// the world makes its step, on another thread: it may read the simulation and what the world
/// doesn't change in advance(). `look` is called with the frozen scene, before velocities are
/// chosen.
void tick(Simulation& simulation, World& world, const std::function<void()>& record = {},
          const std::function<void()>& look = {});

/// The tick's first part, for loops that look or change something in between: the scene as the
/// world has it, and what the road says about each agent (Scene::context).
void observe(Simulation& simulation, World& world);
/// Its second part: everybody that GAMMA drives moves by dt, in the scene alone.
void move_everybody(Simulation& simulation);

}  // namespace sumogamma
