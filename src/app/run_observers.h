#pragma once

#include <memory>
#include <vector>

#include "app/inspector.h"
#include "app/run_plan.h"
#include "io/live_page.h"
#include "io/replay.h"
#include "road/lane_locator.h"
#include "simulation/simulation.h"
#include "sumo/backend.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

/// A run as those see it who watch it.
struct WatchedRun {
  const RunPlan& plan;
  const Simulation& sim;
  SumoWorld& world;
  const LaneLocator& locator;
  SumoBackend& backend;
  LivePage* page;  ///< of --serve, or null

  /// SUMO's id of an agent.
  std::string_view name_of(AgentId id) const { return world.names()[id.value]; }
};

/// Watches a run and writes about it: keys of results.json, or files of its own. One output is one
/// of them in run_observers.cpp, and its line in the list there.
class RunObserver {
 public:
  explicit RunObserver(const WatchedRun& run) : run_(run) {}
  virtual ~RunObserver() = default;
  RunObserver(const RunObserver&) = delete;
  RunObserver& operator=(const RunObserver&) = delete;

  /// Called after every tick. Adds to `events`, and may read what those before it in the list
  /// added.
  virtual void add(std::vector<ReplayEvent>& events) = 0;
  /// Called with the frozen scene of the next tick, before anybody's velocity is chosen.
  virtual void look(Inspector&) {}
  /// Called once, after the last tick: adds what is known of events only now that all is over.
  virtual void add_last(std::vector<ReplayEvent>&) {}
  /// Its part of results.json.
  virtual void fill(RunResults&) const {}
  /// Completes its files. Throws Error naming the file.
  virtual void close() {}

 protected:
  const WatchedRun& run_;
};

/// All that watch a run.
class RunObservers {
 public:
  /// What is handed over must outlive them.
  RunObservers(const RunPlan& plan, const Simulation& sim, SumoWorld& world, SumoBackend& backend,
               LivePage* page = nullptr);

  void add();
  void look();
  void fill(RunResults& results) const;
  void close();

 private:
  WatchedRun run_;
  std::vector<std::unique_ptr<RunObserver>> list_;
  std::vector<ReplayEvent> events_;  ///< of one tick
  Inspector inspector_;
};

}  // namespace sumogamma
