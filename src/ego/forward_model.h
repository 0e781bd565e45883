#pragma once

#include <memory>
#include <vector>

#include "ego/ego_view.h"
#include "simulation/advance.h"

namespace sumogamma {

/// A world of its own to be advanced: what a planner tries in its head.
struct Fork {
  Scene scene;
  RoadState road;
  Traffic traffic;
};

/// A copy of the rows (any order) of a world, and of what they know. Whoever is moved by the world
/// goes on by the model: on its path where it has one, else with its present velocity.
Fork fork_of(const TrafficView& world, std::vector<std::size_t> rows);

/// The model that predicts: a run's own with another step and without the stopping guard, which
/// reckons with the length of the step and would stop the traffic of a prediction.
class ForwardModel {
 public:
  static constexpr double kStep = 1.0 / 3.0;  ///< [s]

  /// Takes the types that `model` has by now, and a copy of all of it the first time.
  void follow(const Model& model);
  /// One step of a fork; rows of Control::Planned move as `planned` asks.
  void advance(Fork& fork, bool rules, const PlannedVelocity& planned);
  const Model& model() const { return *model_; }

 private:
  std::unique_ptr<Model> model_;
  Workers workers_{1};
  AdvanceWork work_;
};

}  // namespace sumogamma
