#pragma once

#include <optional>
#include <vector>

#include "model/model.h"
#include "planning/search_budget.h"
#include "scene/scene.h"

namespace sumogamma {

/// A place of a trajectory: where the ego's centre is to be.
struct TrajectoryPoint {
  double time = 0;  ///< after the plan [s]
  Vec2 position = Vec2::Zero();
};

/// What a planner asks for until its next plan. Its body follows within its own limits.
struct EgoAction {
  double acceleration = 0;         ///< along its heading [m/s^2]
  std::optional<double> steering;  ///< front wheel angle, positive left [rad]; none: its path
  /// From where the ego was when it planned, at time 0, on. Where it isn't empty it alone counts.
  std::vector<TrajectoryPoint> trajectory;
  std::optional<SearchStatistics> search;  ///< what a search for it has found
};

/// Braking as hard as the body can.
EgoAction full_braking(const AgentType& type);

/// When and how fast an action is to be done.
struct ActionPace {
  double max_speed = 0;  ///< [m/s]
  double since = 0;      ///< the plan [s]
  double dt = 0.05;      ///< of the coming step [s]
};

/// The velocity that a row asks of track_velocity for the coming step. Along the path it steers as
/// the model's preferred velocity does, from the row's context, which must be of this step; a
/// trajectory is pursued a quarter of a second ahead. Never faster than pace.max_speed nor
/// backwards.
Vec2 velocity_of(const EgoAction& action, const Model& model, const Scene& scene, std::size_t row,
                 const ActionPace& pace);

}  // namespace sumogamma
