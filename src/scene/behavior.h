#pragma once

#include <cstdint>

#include "geometry/vec2.h"

namespace sumogamma {

/// Att of III-B: two half discs, one ahead and one behind [m].
struct AttentionRange {
  double front = 0;
  double rear = 0;
};

/// What an agent wants (III-D).
enum class IntentionKind : std::uint8_t {
  Goal,              ///< straight to `goal` at the preferred speed
  Path,              ///< along its path on the lane or sidewalk network
  KeepVelocity,      ///< v_pref = current velocity
  KeepAcceleration,  ///< v_pref = current velocity + horizon-limited acceleration
  ConstantTurnRate,
  Stop,
  Velocity,  ///< v_pref = `goal`, which then is a velocity [m/s]: somebody else has chosen
};

struct Intention {
  IntentionKind kind = IntentionKind::Goal;
  Vec2 goal = Vec2::Zero();  ///< [m], for Goal; [m/s], for Velocity
};

/// theta of III-E: the hidden state that the model is conditioned on.
struct BehaviorState {
  Intention intention;
  AttentionRange attention;
  double responsibility = 0.5;  ///< gamma of Eq. 5, in [0, 1]
};

}  // namespace sumogamma
