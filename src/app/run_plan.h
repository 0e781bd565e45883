#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/run_session.h"
#include "io/config.h"
#include "io/results.h"
#include "sumo/scenario_input.h"
#include "sumo/scenario_inventory.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

/// What the options, scenario.toml and the scenario's own configuration together say.
struct RunPlan {
  RunOptions options;
  std::vector<std::string> sumo_words;  ///< --sumo-options, split
  ScenarioInput input;
  ScenarioConfig config;
  ControlChoice control;
  std::optional<ControlRule> inspect;  ///< of --inspect
  ScenarioInventory inventory;
  OutputNames output_names;  ///< of SUMO's files; no marker where SUMO writes them by itself
  RunClock clock;
  bool ends_after_duration = false;  ///< `clock.end` counts from the begin, wherever that is
  double delay = 0;          ///< with a window: between two steps, on the clock on the wall [s]
  std::size_t vehicles = 0;  ///< at once, at the most; 0: as many as the demand has
  std::string control_text;
};

/// Reads the scenario and settles what holds. The nearest word wins: our own options, --set and
/// --sumo-options, then scenario.toml, then the .sumocfg, then defaults. Throws Error for what
/// can't be meant.
RunPlan make_plan(const RunOptions& options, const CommonOptions& common);

/// Once SUMO has loaded, its clock is where the run begins: a loaded state brings its own time.
void settle_begin(double sumo_time, RunPlan& plan);

/// "0 to 600 s (default) in steps of 0.05 s (default), seed 1 (default)", with what should be known
/// of it.
std::string describe(const RunPlan& plan);

}  // namespace sumogamma
