#pragma once

#include <span>

#include "model/attention.h"
#include "model/constraints.h"
#include "model/model.h"

namespace sumogamma {

/// What a row is taken to be up to.
struct RowHypothesis {
  const BehaviorState& behavior;  ///< its responsibility and attention: the behaviour filter asks
                                  ///< with others than the scene's
  const Vec2& preferred;          ///< v_pref [m/s]
};

/// Appends G of Eqs. 3-6 as soft planes: for every attended neighbour the half-plane that takes
/// this row's share of the escape from their velocity obstacle.
void append_geometric_constraints(const Model& model, const Scene& scene,
                                  const TickGeometry& geometry, std::size_t row,
                                  const RowHypothesis& hypothesis,
                                  std::span<const Attended> attended, ConstraintSet& constraints);

/// Share of the escape that `row` takes towards `other`, in [0, 1]. The two shares of a pair add up
/// to 1 where both attend to each other and both are driven by the model; who isn't seen by the
/// other takes all of it.
double responsibility_share(const Model& model, const Scene& scene, const TickGeometry& geometry,
                            std::size_t row, std::size_t other, const BehaviorState& behavior);

}  // namespace sumogamma
