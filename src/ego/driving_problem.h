#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ego/ego_action.h"
#include "ego/way_beliefs.h"
#include "planning/belief_tree.h"
#include "planning/pursuit.h"

namespace sumogamma {

/// What driving is worth, and how it is searched: the constants of the reference's planner
/// (docs/planning.md).
struct DrivingParameters {
  double crash = 3000;            ///< times v^2 + 0.5, ends the scenario
  double speed = 4;               ///< times (v - top speed) / top speed, a step
  double braking = 0.1;           ///< cost of a step of it
  double discount = 0.95;         ///< as the search's
  double noise = 0.05;            ///< probability with which an acceleration has no effect
  double red_deceleration = 3.0;  ///< with which it has to be able to stop at a red line [m/s^2]
  double position_cell = 1.5, speed_cell = 1.0;  ///< of observations [m], [m/s]
  std::size_t observed = 4;  ///< agents that observations tell of: the nearest ones
  EgoControl control;        ///< what counts as a crash
};

/// One scenario: a fork in which everybody has one way and one mind.
struct DrivingState {
  Scene scene;
  RoadState road;
  TrafficState traffic;
};

/// What a plan begins with: the ego and those about it as they are seen, and for each of them what
/// it may do.
struct PlanRoot {
  Fork fork;            ///< its paths are the ego's and the candidates'
  std::size_t ego = 0;  ///< row
  struct Choice {
    PathId path = kNoPath;
    Intention intention;  ///< without a path
    double weight = 0;
  };
  std::vector<std::vector<Choice>> choices;  ///< by row; none: as it is
  std::vector<std::size_t> observed;         ///< rows that observations tell of
};

/// From what is seen and believed. `knows`: everybody's own path instead of a belief.
PlanRoot plan_root(const EgoView& view, const WayBeliefs& beliefs, bool knows,
                   std::size_t observed);

/// Which of the choices of a row that has some is taken in scenario `index` of `count`.
std::size_t draw_choice(const PlanRoot& root, std::size_t row, std::uint64_t key,
                        std::uint32_t index, std::uint32_t count);

/// Scenario `index` of `count`: each agent's ways drawn by their shares (systematic over the
/// scenarios, in an order of its own), and what is hidden in it. A pure function of its arguments.
void draw_scenario(const Model& model, const PlanRoot& root, std::uint64_t key, std::uint32_t index,
                   std::uint32_t count, DrivingState& state);

/// Driving among others as a problem for a belief tree: actions are the ego's accelerations along
/// its path, a step is ForwardModel::kStep long. For one plan; holds references to what it is made
/// from.
class DrivingProblem {
 public:
  using State = DrivingState;

  DrivingProblem(const EgoView& view, const PlanRoot& root, OthersModel others,
                 const DrivingParameters& parameters, ForwardModel& forward);

  StepOutcome step(State& state, int action, double draw);
  /// Those after which it can still stop at the next red line; braking always.
  std::span<const int> actions(const ScenarioGroup<State>& group);
  /// By time to contact along the swept way, everybody else at its present velocity: brakes, keeps
  /// its speed or accelerates; what the most careful of the scenarios asks.
  int default_action(const ScenarioGroup<State>& group);
  /// A crash at the present speed where it comes before the ego could stand, else standing for
  /// ever.
  double value_at_end(const State& state) const;
  /// Accelerates at once and meets nobody.
  double upper_bound(const State& state, int steps) const;

  double acceleration_of(int action) const {
    return accelerations_[static_cast<std::size_t>(action)];
  }

 private:
  bool crashes(const Scene& scene) const;
  double time_to_contact(const State& state) const;
  double way_to_red(const State& state) const;
  std::uint64_t observation(const Scene& scene) const;
  void move_ego_alone(double acceleration, State& state) const;

  const EgoView& view_;
  const PlanRoot& root_;
  OthersModel others_;
  DrivingParameters parameters_;
  ForwardModel& forward_;
  Fork fork_;  ///< the state that is being advanced is put in here
  std::vector<double> accelerations_;
  int keep_ = 0, fastest_ = 0, hardest_ = 0;  ///< actions
  std::vector<int> legal_;
};

}  // namespace sumogamma
