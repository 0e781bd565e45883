#pragma once

#include <gtest/gtest.h>

#include "ego/way_beliefs.h"
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
                       rules_, trace_});
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
  PlanTrace* trace_ = nullptr;
};

/// An ego that stands before a crossroads without signals, and looks at others.
class LookingEgo : public ::testing::Test, protected EgoScene {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("priority"));
    return network;
  }
  LookingEgo() : EgoScene(net()) {
    ego_ = here_.add("car", {"SC", "CN"}, 185, 0);
    here_.scene.control[ego_] = Control::Planned;
  }
  void look() {
    with_view([&](const EgoView& seen) { beliefs_.observe(seen, forward_); });
    ++plan_;
  }
  /// The time between two looks.
  void advance() {
    for (int k = 0; k < 7; ++k) advance_rows(world(), {});  // the ego brakes, and stands
  }

  ForwardModel forward_;
  WayBeliefs beliefs_;
};

}  // namespace sumogamma::testing
