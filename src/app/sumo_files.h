#pragma once

#include <memory>

#include "app/run_observers.h"
#include "outputs/run_outputs.h"

namespace sumogamma {

/// Has SUMO write its own files under hidden names, where sumo-gamma is to write some of them.
/// Throws Error naming what asks for one that can't be had so.
class HiddenOutputs {
 public:
  /// Adds to the words for SUMO.
  explicit HiddenOutputs(RunPlan& plan);
  /// Where SUMO didn't start its files are deleted.
  ~HiddenOutputs();
  HiddenOutputs(const HiddenOutputs&) = delete;
  HiddenOutputs& operator=(const HiddenOutputs&) = delete;

  void keep() { started_ = true; }

 private:
  const RunPlan& plan_;
  bool started_ = false;
};

/// SUMO's outputs, of everybody. Its files are whole after close().
class SumoFiles final : public RunObserver {
 public:
  explicit SumoFiles(const WatchedRun& run);
  static bool is_wanted(const RunPlan& plan) { return !plan.inventory.outputs.empty(); }
  void add(std::vector<ReplayEvent>& events) override;
  void close() override;

 private:
  void see(std::size_t row, bool with_persons);
  void see_waiting();
  void register_vehicle(const KnownAgent& known);
  VehiclePlace place_of(std::size_t row, const KnownAgent& known);
  bool shows_persons() const;

  RunOutputs outputs_;
  SeenStep step_;  ///< the one before the present tick's: whom SUMO drives is missing still
  bool has_step_ = false;
  std::size_t arrivals_ = 0;  ///< that were told
};

/// In a SUMO that runs already no name can be given to a file: throws Error where it writes one
/// that would be wrong.
void require_no_outputs(SumoBackend& backend, const RunPlan& plan);

}  // namespace sumogamma
