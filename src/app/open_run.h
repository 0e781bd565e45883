#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/run_observers.h"
#include "app/run_plan.h"
#include "app/sumo_files.h"
#include "io/output_folder.h"
#include "io/results.h"
#include "simulation/simulation.h"
#include "sumo/backend.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

/// --convert: the copy of the network that SUMO and we run on; gone again where the run doesn't
/// start.
class ConvertedNetwork {
 public:
  ConvertedNetwork() = default;
  ~ConvertedNetwork();
  ConvertedNetwork(const ConvertedNetwork&) = delete;
  ConvertedNetwork& operator=(const ConvertedNetwork&) = delete;
  void make(RunPlan& plan);
  void keep() { file_.clear(); }

 private:
  std::filesystem::path file_;
};

/// A run from its options to its last output, for the command and for users' own loops: who holds
/// one ticks it. Opening throws Error where the scenario can't be run and SumoError where SUMO
/// fails.
class OpenRun {
 public:
  /// No output folder: nothing is written, and a scenario that asks SUMO for outputs is refused.
  OpenRun(const RunOptions& options, const CommonOptions& common);
  OpenRun(const OpenRun&) = delete;
  OpenRun& operator=(const OpenRun&) = delete;

  const CommonOptions common;
  RunPlan plan;
  std::unique_ptr<Simulation> sim;
  std::unique_ptr<SumoBackend> backend;
  std::optional<SumoWorld> world;
  std::optional<LivePage> page;           ///< of --serve
  std::optional<RunObservers> observers;  ///< where there is an output folder

  /// Ends SUMO and completes all files. `ended`: how it ended; `failure`: what SUMO failed with,
  /// empty where it didn't.
  RunResults finish(const std::string& ended, const std::string& failure);

 private:
  std::optional<OutputFolder> folder_;
  ConvertedNetwork converted_;
  std::optional<HiddenOutputs> hidden_;
  std::string backend_name_;
  std::chrono::steady_clock::time_point start_;
  double cpu_start_ = 0;  ///< [s]
};

}  // namespace sumogamma
