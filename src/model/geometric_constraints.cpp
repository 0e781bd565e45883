#include "model/geometric_constraints.h"

#include <algorithm>

#include "model/velocity_obstacle.h"

namespace sumogamma {

namespace {

/// Horizon of a pair on the road [s].
/// differs from the paper: who follows a lane bends with it, so that straight lines over the whole horizon see collisions with
/// oncoming traffic in every curve; leaders, signals and right of way look far ahead instead (C). Avoidance is what is left:
/// the near term. People on foot follow no lane and keep the full horizon.
double road_horizon(const Model& model, const Scene& scene, std::size_t row, std::size_t other, double horizon) {
  constexpr double kLanes = 1.5, kLeader = 0.7;
  const RoadContext& context = scene.context[row];
  if (!context.active) return horizon;
  const bool walker = type_of(model.types, scene.type[row]).kinematics == Kinematics::Holonomic ||
                      type_of(model.types, scene.type[other]).kinematics == Kinematics::Holonomic;
  if (walker) return horizon;
  const bool leader = context.reason == LimitReason::Leader && context.foe == scene.id[other].value;
  return std::min(horizon, leader ? kLeader : kLanes);
}

}  // namespace

double responsibility_share(const Model& model, const Scene& scene, const TickGeometry& geometry,
                            std::size_t row, std::size_t other, const BehaviorState& behavior) {
  if (!model.options.share_responsibility) return behavior.responsibility;
  // SUMO's drivers and those who don't look this way do nothing for this pair
  if (scene.control[other] == Control::External) return 1.0;
  if (!attends(geometry, scene, other, row, scene.behavior[other].attention)) return 1.0;
  const double own = std::max(behavior.responsibility, 0.0);
  const double theirs = std::max(scene.behavior[other].responsibility, 0.0);
  return own + theirs > 0 ? own / (own + theirs) : 0.5;
}

void append_geometric_constraints(const Model& model, const Scene& scene,
                                  const TickGeometry& geometry, std::size_t row,
                                  const BehaviorState& behavior, std::span<const Attended> attended,
                                  ConstraintSet& constraints) {
  if (!model.options.use_avoidance) return;
  const ModelOptions& options = model.options;
  const PassingSide side = options.keep_left ? PassingSide::Left : PassingSide::Right;
  const double own_horizon = type_of(model.types, scene.type[row]).horizon;
  for (const Attended& neighbour : attended) {
    const std::size_t other = neighbour.row;
    const double their_horizon = type_of(model.types, scene.type[other]).horizon;
    const double pair_horizon = options.pair_horizon == PairHorizon::Own ? own_horizon
                                : options.pair_horizon == PairHorizon::Shortest
                                    ? std::min(own_horizon, their_horizon)
                                    : std::max(own_horizon, their_horizon);
    const double horizon = road_horizon(model, scene, row, other, pair_horizon);
    const PolygonDifference difference =
        minkowski_difference(geometry.guarded[other], geometry.guarded[row],
                             scene.position[other] - scene.position[row]);
    const Escape escape = nearest_escape(difference, scene.velocity[row] - scene.velocity[other],
                                         horizon, options.separation_time, side);
    // differs from the paper: a safe pair is held to its safety (as ORCA does) unless the option
    // says otherwise
    if (!escape.colliding && !options.constrain_safe_pairs) continue;
    const double share = responsibility_share(model, scene, geometry, row, other, behavior);
    constraints.append(
        {scene.velocity[row] + share * escape.change, escape.normal},
        {ConstraintKind::Neighbour, static_cast<std::int64_t>(scene.id[other].value)});
  }
}

}  // namespace sumogamma
