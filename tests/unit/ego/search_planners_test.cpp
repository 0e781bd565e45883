#include "ego/search_planners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/extent.h"
#include "support/ego_scene.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;

/// A scene on a crossroads that goes on by the one step, its ego by a planner.
class DrivingTest : public ::testing::Test, protected testing::EgoScene {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("traffic_light"));
    return network;
  }

  DrivingTest() : EgoScene(net()) {
    plan_ = -1;
    here_.road.signal_since.assign(here_.model.road.signals.size(), 0.0);
    show('G');
    settings_.goal_way = 1000;
    goal_ = {Vec2(1e4, 1e4), Vec2(1, 0), 1000};  // never reached
  }
  void show(char letter) {
    for (std::size_t i = 0; i < here_.road.signal_states.size(); ++i)
      here_.road.signal_states[i] = std::string(here_.model.road.signals[i].size, letter);
  }
  /// The ego on the road from the south to the north.
  void add_ego(double along, double speed) {
    ego_ = here_.add("car", {"SC", "CN"}, along, speed);
    here_.scene.control[ego_] = Control::Planned;
  }
  SearchDecision decide(DrivingSearch& search) {
    ++plan_;
    return with_view([&](const EgoView& seen) { return search.decide(seen); });
  }
  void advance(double acceleration, double seconds = 0.35) {
    EgoAction action;
    action.acceleration = acceleration;
    for (double time = 0; time < seconds - 1e-9; time += 0.05)
      advance_rows(world(), {.rules = rules_}, [&](const TrafficView& now, std::size_t row) {
        return velocity_of(action, now.model, now.scene, row, {settings_.max_speed, 0.0, 0.05});
      });
  }
  void drive(DrivingSearch& search, int plans) {
    for (int k = 0; k < plans; ++k) advance(decide(search).acceleration);
  }
  double speed() const { return here_.scene.speed[ego_]; }
  double front() const { return here_.scene.path_along[ego_] + 2.25; }
};

class EveryPlanner : public DrivingTest, public ::testing::WithParamInterface<SearchPlanner> {};

TEST_P(EveryPlanner, AcceleratesToItsTopSpeedWhereNobodyIs) {
  add_ego(20, 0);
  DrivingSearch search(GetParam());
  drive(search, 9);
  EXPECT_NEAR(speed(), settings_.max_speed, 0.3);
  for (int k = 0; k < 12; ++k) {
    drive(search, 1);
    EXPECT_NEAR(speed(), settings_.max_speed, 0.3);
  }
}

TEST_P(EveryPlanner, StandsBeforeWhatBlocksItsWay) {
  add_ego(20, 4);
  const std::size_t wall = here_.add("car", {"SC", "CN"}, 60, 0);
  here_.scene.control[wall] = Control::Parked;
  DrivingSearch search(GetParam());
  drive(search, 40);
  EXPECT_LT(speed(), 0.05);
  const double gap = here_.scene.path_along[wall] - 2.25 - front();
  EXPECT_GT(gap, 0.3);
  EXPECT_LT(gap, 12.0);
}

TEST_P(EveryPlanner, StandsAtARedLine) {
  show('r');
  add_ego(120, 6);
  DrivingSearch search(GetParam());
  drive(search, 60);
  const double line = here_.path(ego_).links.front().stop_line;
  EXPECT_LT(speed(), 0.05);
  EXPECT_LE(front(), line);
  EXPECT_GT(front(), line - 6.0);
  show('G');
  drive(search, 10);
  EXPECT_GT(speed(), 4.0);
}

INSTANTIATE_TEST_SUITE_P(All, EveryPlanner,
                         ::testing::Values(SearchPlanner::PomdpGamma, SearchPlanner::RolloutGamma,
                                           SearchPlanner::PomdpSimple, SearchPlanner::Policy,
                                           SearchPlanner::Oracle));

TEST_F(DrivingTest, TheLikelierACrossingCarGoesOnTheEarlierItBrakes) {
  rules_ = false;
  add_ego(100, 6);
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 100, 8, 0, -1, "WC_0");
  CandidateWays candidates(net());
  const AgentTypeId car = here_.scene.type[foe];
  std::shared_ptr<const Path> on, off;  // straight over the ego's way, or off to the right before
  for (const auto& way :
       candidates.ways(type_of(here_.model.types, car), car, net().lane_by_name.at("WC_0"))) {
    const LaneId to = net().connection(way->links.front().connection).to;
    const std::string& edge = net().edge(net().lane(to).edge).name;
    if (edge == "CE") on = way;
    if (edge == "CS") off = way;
  }
  ASSERT_TRUE(on && off);
  // where their ways meet, along each
  const Vec2 middle(here_.path(ego_).line.point_at(195).x(), on->line.point_at(195).y());
  const double own = here_.path(ego_).line.project(middle).along;
  const double its = on->line.project(middle).along;

  /// Of an approach in which both would be there at once: how long before does it first brake [s]?
  const auto brakes_at = [&](double share) {
    for (double ahead = 4.5; ahead > 0.4; ahead -= 0.25) {
      here_.move(ego_, own - 6 * ahead);
      here_.set_speed(ego_, 6);
      here_.move(foe, its - 8 * ahead);
      here_.set_speed(foe, 8);
      const double acceleration = with_view([&](const EgoView& seen) {
        ForwardModel forward;
        forward.follow(here_.model);
        PlanRoot root = plan_root(seen, WayBeliefs(), false, 4);
        const std::size_t place = root.fork.road.paths.size();
        root.fork.road.paths.insert(root.fork.road.paths.end(), {on, off});
        root.choices[find_row(root.fork.scene, here_.scene.id[foe])] = {
            {static_cast<PathId>(place), {}, share},
            {static_cast<PathId>(place + 1), {}, 1 - share}};
        DrivingProblem problem(seen, root, OthersModel::ConstantSpeed, {}, forward);
        constexpr std::uint32_t kScenarios = 20;
        std::vector<DrivingState> states(kScenarios);
        const std::vector<double> weights(kScenarios, 1.0 / kScenarios);
        for (std::uint32_t i = 0; i < kScenarios; ++i)
          draw_scenario(forward.model(), root, 7, i, kScenarios, states[i]);
        BeliefTree<DrivingProblem> tree;
        const SearchResult found = tree.search(problem, {states, weights, 7}, PlanSize{}.search,
                                               SearchBudget{.steps = 20000});
        return problem.acceleration_of(found.action);
      });
      if (acceleration < 0) return ahead;
    }
    return 0.0;
  };
  std::vector<double> times;
  for (const double share : {0.0, 0.1, 0.3, 0.6, 1.0}) times.push_back(brakes_at(share));
  EXPECT_EQ(times.front(), 0.0) << "it turns off for certain";
  EXPECT_GT(times.back(), 1.0) << "it goes on for certain";
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end())) << ::testing::PrintToString(times);
}

TEST_F(DrivingTest, ADeadlineCutsASearchAndIsSaid) {
  add_ego(150, 6);
  here_.add("car", {"WC", "CE"}, 165, 8);
  PlanSize size;
  size.scene_steps = 1'000'000'000;
  size.deadline = 1e-4;
  DrivingSearch search(SearchPlanner::PomdpGamma, size);
  EXPECT_TRUE(decide(search).statistics.stopped);
}

// with two trees, too, and by both threads
TEST_F(DrivingTest, TwoTreesDecideByHalfOfTheScenariosEach) {
  add_ego(150, 6);
  here_.add("car", {"WC", "CE"}, 165, 8);
  here_.add("car", {"EC", "CS"}, 150, 8);
  PlanSize size;
  size.trees = 2;
  DrivingSearch one(SearchPlanner::PomdpGamma, size), other(SearchPlanner::PomdpGamma, size),
      single(SearchPlanner::PomdpGamma);
  const SearchDecision first = decide(one);
  --plan_;
  const SearchDecision second = decide(other);
  --plan_;
  const SearchDecision by_one = decide(single);
  EXPECT_EQ(first.action, second.action);
  EXPECT_EQ(first.statistics.nodes, second.statistics.nodes);
  EXPECT_EQ(first.statistics.lower, second.statistics.lower);
  EXPECT_LE(first.statistics.steps, size.scene_steps + size.scene_steps / 10);
  EXPECT_GT(first.statistics.steps, size.scene_steps / 2) << "it thinks as long";
  EXPECT_NE(first.statistics.lower, by_one.statistics.lower) << "as two";
}

TEST_F(DrivingTest, APlanChangesNothingAndIsTheSameAgain) {
  add_ego(150, 6);
  here_.add("car", {"WC", "CE"}, 165, 8);
  here_.add("car", {"EC", "CS"}, 150, 8);
  look_about(world(), {.rules = rules_});
  const std::uint64_t before = hash_state(here_.scene);
  DrivingSearch one(SearchPlanner::PomdpGamma), other(SearchPlanner::PomdpGamma);
  const SearchDecision first = decide(one);
  EXPECT_EQ(hash_state(here_.scene), before);
  --plan_;
  const SearchDecision second = decide(other);
  EXPECT_EQ(first.action, second.action);
  EXPECT_EQ(first.statistics.nodes, second.statistics.nodes);
  EXPECT_EQ(first.statistics.lower, second.statistics.lower);
  EXPECT_EQ(first.statistics.upper, second.statistics.upper);
  EXPECT_LE(first.statistics.lower, first.statistics.upper);
}

TEST_F(DrivingTest, BrakingNeverLengthensTheWay) {
  add_ego(140, 5);
  here_.add("car", {"WC", "CE"}, 160, 8);
  with_view([&](const EgoView& seen) {
    ForwardModel forward;
    forward.follow(here_.model);
    const PlanRoot root = plan_root(seen, WayBeliefs(), true, 4);
    DrivingProblem problem(seen, root, OthersModel::Gamma, {}, forward);
    std::vector<double> ways;
    for (const int action : {2, 0, 1}) {  // brake, keep, accelerate
      DrivingState state;
      draw_scenario(forward.model(), root, 1, 0, 1, state);
      for (int k = 0; k < 4; ++k) problem.step(state, action, 0.5);
      ways.push_back(state.scene.path_along[root.ego]);
    }
    EXPECT_LT(ways[0], ways[1]);
    EXPECT_LT(ways[1], ways[2]);
  });
}

}  // namespace
}  // namespace sumogamma
