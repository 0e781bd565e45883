#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "inference/motion_estimate.h"
#include "scene/agent_type.h"
#include "scene/behavior.h"

namespace sumogamma {

/// Intentions that the filter tells apart. The last three need a road network: to go on along the
/// lane, sidewalk or crossing, at the next junction straight on, left or right.
enum class IntentionHypothesis : std::uint8_t {
  KeepVelocity,
  KeepAcceleration,
  ConstantTurnRate,
  Stop,
  RoadAhead,
  RoadLeft,
  RoadRight
};
inline constexpr std::size_t kIntentions = 7;
inline constexpr std::size_t kFreeIntentions = 4;  ///< those that need no road
std::string_view name_of(IntentionHypothesis intention);

inline constexpr std::size_t kAttentions = 2;
inline constexpr std::size_t kResponsibilities = 2;

/// How an intention that is not interrupted fades over time: nobody accelerates or turns for ever.
struct IntentionShape {
  double acceleration_decay = 0.8;  ///< over which a present acceleration fades [s]
  double speed_decay = 0;           ///< rate at which speed is lost [1/s]
  double turn_decay = 1.5;          ///< over which a present turn fades [s]
  double stop_time = 1.0;           ///< over which somebody who stops loses speed [s]
};

/// How changes fade over the periods to come: what intended_path needs of a shape alone.
struct IntentionTimes {
  static constexpr std::size_t kMost = 12;  ///< periods
  IntentionTimes() = default;
  IntentionTimes(const IntentionShape& shape, double period);

  double period = 0.4;              ///< [s]
  double acceleration_decay = 0.8;  ///< [s]
  /// By period's end: way at unit speed that loses it, that of an acceleration over its decay, and
  /// way at unit speed of who stops [s].
  std::array<double, kMost> way{}, gain{}, stop{};
  /// By its middle: turn at unit rate, speed gained at unit acceleration [s], and share kept.
  std::array<double, kMost> turn{}, faster{}, kept{};
};

/// Displacement of one intention at 1, 2, ... periods from now [m], without anybody in the way.
/// Equivariant under rotation. The Stop hypothesis never turns back. The ways of the road are not
/// known here: theirs is that of KeepAcceleration.
/// At most IntentionTimes::kMost of them.
void intended_path(IntentionHypothesis intention, const MotionEstimate& motion,
                   const IntentionTimes& times, std::span<Vec2> displacement);

/// r_front of a type under hypothesis k (the paper's two: 6 and 8 m on foot, 8 and 10 m on wheels);
/// r_rear is the type's own.
AttentionRange attention_of(const AgentType& type, std::size_t k);

/// gamma of Eq. 5 under hypothesis k: ready to give way, or not.
double responsibility_of(std::size_t k);

}  // namespace sumogamma
