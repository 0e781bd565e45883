#pragma once

#include "model/model.h"

namespace sumogamma {

/// v_pref of III-D [m/s] for one row under an intention: Goal and Path point at the sub-goal with
/// the preferred (or the road's) speed; KeepVelocity, KeepAcceleration (over half the horizon,
/// speed kept in [0, max]), ConstantTurnRate and Stop need no context. Null at the goal itself.
Vec2 preferred_velocity(const Model& model, const Scene& scene, std::size_t row,
                        const Intention& intention);

/// Share of a velocity that a wheeled body has along its heading once it is asked for it (see
/// advance_body), in [0.8, 1]: of what points further aside it makes less. 1 for the null velocity.
double share_ahead(const Vec2& velocity, const Vec2& forward);

/// The side to which somebody on foot turns who is held up: 1 left, -1 right. Who has chosen a
/// place beside the one that it likes, past whoever is in its way, turns towards that.
double side_to_pass(const ModelOptions& options, const Scene& scene, std::size_t row);

}  // namespace sumogamma
