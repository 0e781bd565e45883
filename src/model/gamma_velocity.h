#pragma once

#include <cstdint>
#include <vector>

#include "geometry/half_plane_program.h"
#include "model/attention.h"
#include "model/constraints.h"
#include "model/model.h"
#include "model/stopping_guard.h"
#include "model/tick_geometry.h"
#include "model/tracking.h"

namespace sumogamma {

/// Scratch of one thread. After a call it tells how the velocity came about: a replay draws it, a
/// failing test prints it.
struct Workspace {
  Neighbours neighbours;
  ConstraintSet constraints;
  ProgramScratch program;
  StoppingGuard guard;
  std::vector<std::uint32_t> sides;  ///< of solid things nearby
  std::vector<HalfPlane> firm;       ///< hard planes that hold for a wedged vehicle, too
  Vec2 preferred = Vec2::Zero();     ///< v_pref [m/s]
  double fastest = 0;                ///< Eq. 7 looks no farther from the null velocity [m/s]
  ProgramResult result;              ///< of Eq. 7; result.binding is an index into constraints

  /// Where the plane that holds the velocity comes from; null where v_pref itself was feasible.
  const ConstraintSource* binding_source() const {
    return result.binding < 0 ? nullptr
                              : &constraints.sources[static_cast<std::size_t>(result.binding)];
  }
};

/// What kept a row from its preferred velocity: for whom it is to be told in a word.
enum class BindingKind : std::uint8_t {
  None,  ///< nothing did
  Kinematic,
  Neighbour,
  Obstacle,
  LaneBoundary,
  Direction,
  RoadLimit,  ///< RoadContext::reason says which
  Guard,      ///< the stopping guard
  BackingOut  ///< it backs out of a deadlock, and Eq. 7 wasn't asked
};
struct Binding {
  BindingKind kind = BindingKind::None;
  std::int64_t foe = -1;  ///< as ConstraintSource::foe
};

/// v_new of Eq. 7 [m/s]: the velocity nearest to the preferred one within K, C and G, for one row
/// of the frozen scene under a hypothesis of its behaviour. Reads everything, writes only `work`,
/// so rows may be computed in any order and thread. Always finite, always within K and C, null at
/// the worst.
Vec2 gamma_velocity(const Model& model, const Scene& scene, const TickGeometry& geometry,
                    std::size_t row, const BehaviorState& behavior, Workspace& work);

/// What held the `velocity` that gamma_velocity has just answered with `work`.
Binding binding_of(const Scene& scene, std::size_t row, const Vec2& velocity,
                   const Workspace& work);

/// The row's body `dt` [s] after the `velocity` that gamma_velocity has just answered with `work`:
/// what track_velocity gives, mostly at no cost because the guard has looked at it.
inline BodyState next_body(const Model& model, const Scene& scene, std::size_t row,
                           const Vec2& velocity, double dt, const Workspace& work) {
  const BodyState* body = work.guard.body_after(velocity);
  if (body && dt == model.options.step) return *body;
  return track_velocity(model, scene, row, velocity, dt);
}

}  // namespace sumogamma
