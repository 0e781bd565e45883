#include "ego/plan_trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "ego/ego_driver.h"
#include "ego/plan_tree.h"
#include "ego/search_planners.h"
#include "support/ego_scene.h"

namespace sumogamma {
namespace {

/// An ego that stands before a crossroads, a car that comes from the left and somebody who walks.
class PlanTraceTest : public testing::LookingEgo {
 protected:
  PlanTraceTest() {
    foe_ = here_.add("car", {"WC", "CE"}, 150, 10, 0, -1, "WC_1");
    walker_ = here_.add("car", {"EC", "CW"}, 180, 0);
    here_.scene.type[walker_] = find_agent_type(here_.model.types, "pedestrian");
    here_.scene.path[walker_] = kNoPath;
    here_.scene.velocity[walker_] = Vec2(0, 1.2);
    here_.scene.speed[walker_] = 1.2;
    here_.scene.behavior[walker_].intention = {IntentionKind::Velocity, Vec2(0, 1.2)};
    rules_ = false;
  }
  /// What a planner does at a few looks in a row, the last of them traced.
  EgoAction plan(const Planner& planner, PlanTrace* trace) {
    EgoAction action;
    for (plan_ = 0; plan_ < 4; ++plan_) {
      if (plan_ > 0) advance();
      trace_ = plan_ == 3 ? trace : nullptr;
      action = with_view([&](const EgoView& seen) { return planner(seen); });
    }
    return action;
  }
  void expect_sound_beliefs(const PlanTrace& trace) const {
    ASSERT_EQ(trace.beliefs.size(), 2u);
    for (const PlanTrace::Belief& belief : trace.beliefs) {
      const Vec2 place = here_.scene.position[find_row(here_.scene, belief.id)];
      double sum = 0;
      for (const PlanTrace::Way& way : belief.ways) {
        sum += way.probability;
        ASSERT_FALSE(way.line.empty());
        EXPECT_EQ(way.line.front(), place);
        if (way.line.size() == 1) continue;
        EXPECT_LT((way.line.back() - place).norm(), 60.0) << "for four seconds";
        EXPECT_GT((way.line.back() - place).norm(), 2.0);
      }
      EXPECT_NEAR(sum, 1.0, 1e-12);
      EXPECT_EQ(belief.ways.back().line.size(), 1u) << "the last way is to stop";
    }
  }

  std::size_t foe_ = 0, walker_ = 0;
};

TEST_F(PlanTraceTest, OfASearchHasWaysScenariosAndWhatActionsAreWorth) {
  for (const SearchPlanner kind :
       {SearchPlanner::PomdpGamma, SearchPlanner::RolloutGamma, SearchPlanner::PomdpSimple}) {
    SCOPED_TRACE(static_cast<int>(kind));
    PlanTrace trace;
    const EgoAction action = plan(make_search_planner(kind), &trace);
    expect_sound_beliefs(trace);
    const auto count = static_cast<double>(trace.scenarios.size());
    EXPECT_EQ(count, kind == SearchPlanner::RolloutGamma ? 20 : 5);
    for (const PlanTrace::Belief& belief : trace.beliefs) {
      std::vector<double> taken(belief.ways.size());
      for (const PlanTrace::Scenario& scenario : trace.scenarios)
        for (const PlanTrace::Part& part : scenario)
          if (part.id == belief.id) taken.at(static_cast<std::size_t>(part.way)) += 1;
      for (std::size_t way = 0; way < taken.size(); ++way)
        EXPECT_NEAR(taken[way], count * belief.ways[way].probability, 1.0 + 1e-9)
            << "as often as it is believed";
    }
    EXPECT_EQ(trace.figures, PlanTrace::Figures::Values);
    ASSERT_EQ(trace.choices.size(), 3u);
    double best = -1e9, chosen = -1e9;
    for (const PlanTrace::Choice& choice : trace.choices) {
      EXPECT_LE(choice.lower, choice.upper);
      best = std::max(best, choice.lower);
      if (choice.acceleration == action.acceleration) chosen = choice.lower;
    }
    EXPECT_EQ(chosen, best);
    EXPECT_EQ(static_cast<std::int64_t>(trace.tree.size()), action.search->nodes);
    std::vector<double> weights(trace.tree.size());
    for (std::size_t k = 1; k < trace.tree.size(); ++k) {
      const PlanTrace::TreeNode& node = trace.tree[k];
      ASSERT_GE(node.parent, 0);
      ASSERT_LT(node.parent, static_cast<std::int32_t>(k)) << "parents before children";
      const PlanTrace::TreeNode& parent = trace.tree[static_cast<std::size_t>(node.parent)];
      EXPECT_EQ(node.depth, parent.depth + 1);
      if (node.acceleration == 3.0) weights[static_cast<std::size_t>(node.parent)] += node.weight;
    }
    EXPECT_NEAR(weights.front(), 1.0, 1e-12) << "under an action all scenarios are somewhere";
    const std::string svg = plan_tree_svg(trace);
    std::size_t circles = 0;
    for (std::size_t at = svg.find("<circle"); at != std::string::npos;
         at = svg.find("<circle", at + 1))
      ++circles;
    EXPECT_EQ(circles, trace.tree.size());
  }
}

TEST_F(PlanTraceTest, OfTwoTreesHasBothTreesFigures) {
  PlanSize size;
  size.trees = 2;
  DrivingSearch search(SearchPlanner::PomdpGamma, size);
  PlanTrace trace;
  plan(
      [&](const EgoView& seen) {
        EgoAction action;
        action.acceleration = search.decide(seen).acceleration;
        return action;
      },
      &trace);
  ASSERT_EQ(trace.choices.size(), 3u);
  EXPECT_TRUE(std::any_of(trace.choices.begin(), trace.choices.end(),
                          [](const auto& choice) { return std::isfinite(choice.lower); }));
}

TEST_F(PlanTraceTest, OfFuturesHasWhereEverybodyIsInThem) {
  PlanTrace trace;
  const EgoAction action = plan(make_planner("futures"), &trace);
  expect_sound_beliefs(trace);
  EXPECT_EQ(trace.figures, PlanTrace::Figures::Meetings);
  ASSERT_FALSE(trace.choices.empty());
  EXPECT_EQ(trace.choices.back().acceleration, action.acceleration) << "the first that will do";
  ASSERT_EQ(trace.scenarios.size(), 9u);
  for (const PlanTrace::Scenario& scenario : trace.scenarios) {
    ASSERT_EQ(scenario.size(), 3u) << "with the ego";
    EXPECT_EQ(scenario.front().id, here_.scene.id[ego_]);
    for (const PlanTrace::Part& part : scenario) {
      ASSERT_EQ(part.line.size(), 5u) << "now, and after each of four seconds";
      EXPECT_EQ(part.line.front(), here_.scene.position[find_row(here_.scene, part.id)]);
    }
  }
}

TEST_F(PlanTraceTest, ChangesNoPlan) {
  for (const PlannerEntry& entry : planners()) {
    if (entry.make == nullptr) continue;
    SCOPED_TRACE(std::string(entry.name));
    const Scene begin = here_.scene;
    PlanTrace trace;
    const EgoAction with = plan(entry.make(), &trace);
    const std::uint64_t after = hash_state(here_.scene);
    here_.scene = begin;
    traffic_.state = {};
    const EgoAction without = plan(entry.make(), nullptr);
    EXPECT_EQ(with.acceleration, without.acceleration);
    EXPECT_EQ(hash_state(here_.scene), after);
    if (!with.search) continue;
    EXPECT_EQ(with.search->lower, without.search->lower);
    EXPECT_EQ(with.search->steps, without.search->steps);
  }
}

TEST_F(PlanTraceTest, OfAPlannerWithoutBeliefsIsItsAction) {
  std::vector<PlanTrace> seen;
  EgoTask task{settings_, goal_, 1, 0.05, false};
  task.look_on = [&](const PlanTrace& trace) { seen.push_back(trace); };
  EgoDriver driver(std::move(task), workers_, make_planner("idm"));
  for (int tick = 0; tick < 14; ++tick) advance_rows(world(), {.rules = false}, std::ref(driver));
  ASSERT_EQ(seen.size(), 2u);
  ASSERT_EQ(driver.plans().size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(seen[k].ego, here_.scene.id[ego_]);
    EXPECT_EQ(seen[k].action.acceleration, driver.plans()[k].action.acceleration);
    EXPECT_TRUE(seen[k].beliefs.empty() && seen[k].scenarios.empty() && seen[k].choices.empty());
  }
  EXPECT_LT(seen[0].time, seen[1].time);
}

}  // namespace
}  // namespace sumogamma
