#include "model/gamma_velocity.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "geometry/rotation.h"
#include "model/context.h"
#include "model/geometric_constraints.h"
#include "model/kinematic_set.h"
#include "model/nearby.h"
#include "model/obstacle_constraints.h"
#include "model/preferred_velocity.h"

namespace sumogamma {

namespace {

// people on foot who make less than this share of their preferred speed look for a way round, up to
// this far aside
constexpr double kHeldShare = 0.5;
constexpr double kLookAside = 1.0;  // [rad]

/// differs from the paper: who is held up turns its preferred velocity to the passing side, the
/// more the longer it stands. In a crowd that meets head-on this starts the roundabout that
/// resolves it, the same way for all and without a draw.
Vec2 look_aside(const ModelOptions& options, const Scene& scene, std::size_t row,
                const AgentGeometry& agent, const Vec2& preferred) {
  const double wish = preferred.squaredNorm();
  if (agent.on_wheels || !options.look_aside || wish < 1e-12) return preferred;
  const double made = agent.velocity.dot(preferred) / wish;
  if (made >= kHeldShare) return preferred;
  const double held = std::min(1.0 - made / kHeldShare, 1.0);
  return from_body(rotation(side_to_pass(options, scene, row) * kLookAside * held), preferred);
}

/// Fastest that Eq. 7 may answer [m/s].
double speed_limit(const AgentType& type, const Scene& scene, const AgentGeometry& agent,
                   std::size_t row, const Vec2& preferred) {
  const double fastest =
      std::min(type.max_speed, std::max(scene.preferred_speed[row], preferred.norm()));
  // what the road allows holds for a wheeled body whichever way it points, and for its speed along
  // its heading: asked for aside it would else get slower with every step in a bend
  const RoadContext& context = scene.context[row];
  if (!context.active || type.kinematics == Kinematics::Holonomic) return fastest;
  return std::min(fastest,
                  std::max(context.allowed_speed, 0.0) / share_ahead(preferred, agent.forward));
}

/// differs from the paper: of the velocities on a road that break G hardly more than the least
/// possible, the one nearest to the preferred is taken. Two vehicles that were squeezed together
/// side by side would else stand for ever: no velocity that they can track parts them, and rolling
/// on breaks G by a hair more than standing.
void ease_violation(double fastest, Workspace& work) {
  constexpr double kHair = 0.1;  // [m/s]
  if (work.result.violation <= 1e-6) return;
  ConstraintSet& constraints = work.constraints;
  for (std::size_t k = constraints.hard_count; k < constraints.planes.size(); ++k)
    constraints.planes[k].point -= (work.result.violation + kHair) * constraints.planes[k].normal;
  const double violation = work.result.violation;
  work.result = closest_point(constraints.planes, constraints.hard_count, work.preferred, fastest,
                              work.program);
  work.result.violation = violation;
}

/// Hard planes that a body which creeps out of the way must keep. A vehicle that is wedged may use
/// what lies beside its lane to get out, not far, and its middle stays on its own carriageway.
std::span<const HalfPlane> planes_for_creeping(const Scene& scene, std::size_t row,
                                               Workspace& work) {
  constexpr double kFarthest = 0.8;  // beyond the boundary [m]
  const ConstraintSet& constraints = work.constraints;
  const std::span hard(constraints.planes.data(), constraints.hard_count);
  if (!is_wedged(scene, row)) return hard;
  const RoadContext& context = scene.context[row];
  work.firm.clear();
  for (std::size_t k = 0; k < hard.size(); ++k) {
    const bool on_left = hard[k].normal.dot(left_of(context.tangent)) < 0.0;
    const double room = on_left ? context.room_left : context.room_right;
    const double edge = on_left ? context.edge_left : context.edge_right;
    const bool firm = room < -kFarthest || edge < 0.0;
    if (firm || constraints.sources[k].kind != ConstraintKind::LaneBoundary)
      work.firm.push_back(hard[k]);
  }
  return work.firm;
}

void set_preferred(const Model& model, const Scene& scene, std::size_t row,
                   const BehaviorState& behavior, Workspace& work) {
  work.preferred = preferred_velocity(model, scene, row, behavior.intention);
  if (!work.preferred.allFinite()) work.preferred = Vec2::Zero();
}

/// Eq. 7 among the neighbours that were found.
void solve(const Model& model, const Scene& scene, const TickGeometry& geometry, std::size_t row,
           const BehaviorState& behavior, Workspace& work) {
  const AgentType& type = type_of(model.types, scene.type[row]);
  ConstraintSet& constraints = work.constraints;
  constraints.clear();
  append_kinematic_constraints(model, scene, row, geometry.agent[row].forward,
                               constraints);                      // K, III-A
  append_contextual_constraints(model, scene, row, constraints);  // C, III-C
  append_obstacle_constraints(model, scene, geometry, row, work.sides, constraints);
  constraints.hard_count = constraints.planes.size();
  append_geometric_constraints(model, scene, geometry, row, {behavior, work.preferred},
                               work.neighbours.attended, constraints);  // G, III-B

  const Vec2 target = look_aside(model.options, scene, row, geometry.agent[row], work.preferred);
  work.fastest = speed_limit(type, scene, geometry.agent[row], row, work.preferred);
  work.result =
      closest_point(constraints.planes, constraints.hard_count, target, work.fastest, work.program);
  if (scene.context[row].active && geometry.agent[row].on_wheels)
    ease_violation(work.fastest, work);
}

}  // namespace

Vec2 gamma_velocity_among(const Model& model, const Scene& scene, const TickGeometry& geometry,
                          const BehaviorState& behavior, const Nearby& nearby, Workspace& work) {
  const std::size_t row = nearby.row;
  assert(!model.options.use_guard);
  set_preferred(model, scene, row, behavior, work);
  attend_among(nearby, geometry.agent[row], behavior.attention, work.preferred,
               type_of(model.types, scene.type[row]).horizon, work.neighbours.attended);
  solve(model, scene, geometry, row, behavior, work);
  return work.result.point;
}

Vec2 gamma_velocity(const Model& model, const Scene& scene, const TickGeometry& geometry,
                    std::size_t row, const BehaviorState& behavior, Workspace& work) {
  set_preferred(model, scene, row, behavior, work);
  find_neighbours(model.road, geometry, row, behavior.attention, work.preferred,
                  type_of(model.types, scene.type[row]).horizon, work.neighbours);
  solve(model, scene, geometry, row, behavior, work);
  if (!model.options.use_guard) return work.result.point;

  // differs from the paper: what half-planes can't say about turning and braking bodies
  work.guard.prepare(model, scene, geometry, row, work.neighbours.near);
  const std::span hard = planes_for_creeping(scene, row, work);
  const double wish = work.preferred.norm(), fastest = work.fastest;
  const Vec2 allowed = wish > fastest ? Vec2(work.preferred * (fastest / wish)) : work.preferred;
  return guarded_velocity(work.guard, model, scene, geometry, row, work.result.point, allowed,
                          hard);
}

Binding binding_of(const Scene& scene, std::size_t row, const Vec2& velocity,
                   const Workspace& work) {
  constexpr double kSame = 1e-6;  // [m/s]
  if ((velocity - work.result.point).squaredNorm() > kSame * kSame) return {BindingKind::Guard, -1};
  if (const ConstraintSource* source = work.binding_source())
    return {static_cast<BindingKind>(static_cast<int>(source->kind) + 1), source->foe};
  // what the road allows is a plane and a greatest speed: the latter comes first
  const RoadContext& context = scene.context[row];
  const bool by_road = context.active && std::isfinite(context.allowed_speed) &&
                       work.preferred.norm() > work.fastest + kSame;
  return by_road ? Binding{BindingKind::RoadLimit, context.foe} : Binding{};
}

}  // namespace sumogamma
