#pragma once

#include <memory>
#include <string>

#include "app/run_plan.h"
#include "simulation/simulation.h"
#include "sumo/backend.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

/// The simulation of a plan before its first tick: model, road and rules. Throws Error naming the
/// file where the network can't be read.
std::unique_ptr<Simulation> make_simulation(const RunPlan& plan, unsigned threads);

/// SUMO, loaded and ready to step. `name` becomes that of the back end. Throws Error in the user's
/// words where SUMO refuses the scenario.
std::unique_ptr<SumoBackend> start_backend(const RunPlan& plan, const RoadNetwork& network,
                                           std::string& name);

SumoWorldOptions world_options_of(const RunPlan& plan);

}  // namespace sumogamma
