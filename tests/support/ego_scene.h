#pragma once

#include "ego/ego_view.h"
#include "simulation/advance.h"
#include "support/road_scene.h"

namespace sumogamma::testing {

/// A scene with an ego, that goes on by the one step, as a planner sees it.
class EgoScene {
 protected:
  explicit EgoScene(const RoadNetwork& network) : here_(network) {}

  Advance world() { return {here_.model, workers_, here_.road, here_.scene, traffic_, work_}; }
  /// Calls use(EgoView) with what a planner is asked with for plan number `plan_`.
  template <class Use>
  auto with_view(Use use) {
    look_about(world(), {.rules = rules_});
    const TrafficView traffic{here_.model,
                              here_.road,
                              here_.scene,
                              traffic_.state,
                              work_.geometry.grid,
                              traffic_.approaches,
                              traffic_.perception,
                              traffic_.waits,
                              traffic_.parameters,
                              traffic_.code,
                              rules_};
    return use(EgoView{traffic, workers_, ego_, settings_, goal_, 1, plan_, here_.scene.time, 0.0,
                       rules_});
  }

  RoadScene here_;
  Workers workers_{1};
  Traffic traffic_;
  AdvanceWork work_;
  EgoSettings settings_;
  EgoGoal goal_;
  bool rules_ = true;
  std::size_t ego_ = 0;
  std::int64_t plan_ = 0;
};

}  // namespace sumogamma::testing
