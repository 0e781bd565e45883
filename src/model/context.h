#pragma once

#include "model/constraints.h"
#include "model/model.h"

namespace sumogamma {

/// Appends C of III-C for one row from scene.context[row]: lane boundaries at d/tau, no motion
/// against the direction of travel, and the speed that leader, signals and rules leave. Every plane
/// admits the null velocity, so standing is always allowed. Appends nothing for an agent off the
/// network.
void append_contextual_constraints(const Model& model, const Scene& scene, std::size_t row,
                                   ConstraintSet& constraints);

}  // namespace sumogamma
