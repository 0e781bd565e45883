#pragma once

#include <array>
#include <span>
#include <string_view>

#include "geometry/vec2.h"
#include "prediction/flow_memory.h"

namespace sumogamma {

/// Ways in which an agent may go on, weighed by how they did on what was seen (expert_weights.h).
enum class Expert : std::size_t {
  Model,             ///< the mean of the intentions of the behaviour filter
  Walking,           ///< the regression of walking_model.h, people on foot alone
  LastDisplacement,  ///< constant velocity
  MeanDisplacement,  ///< the mean of the last three displacements goes on
  Kalman,            ///< constant velocity behind the motion filter
  Acceleration,      ///< the mean acceleration of the last two changes goes on
  BriefTurn,   ///< turn rate and acceleration of the last three displacements, fading over 3 steps
  LongTurn,    ///< the same over 6 steps
  FreshTurn,   ///< turn rate and acceleration of the last two displacements, over 8 steps
  LaneSteady,  ///< along the ways of the lane under it (lane_guide.h), at one speed
  LaneChanging,  ///< likewise, as far as its acceleration leads
  LaneDriven,    ///< likewise, as limits, bends, those ahead and red lights let it
};
inline constexpr std::size_t kExperts = 12;
/// The first of those that need a map, which are the last.
inline constexpr std::size_t kFirstLaneExpert = static_cast<std::size_t>(Expert::LaneSteady);
std::string_view name_of(Expert expert);

/// Displacements at the steps to come [m].
using ExpertPath = std::array<Vec2, FlowMemory::kSteps>;

/// The j-th last displacement of a track, the oldest known for older ones; null for a newcomer [m].
Vec2 displacement_before(std::span<const Vec2> position, std::size_t j);
/// Mean of the last `count` displacements, or of those that there are [m].
Vec2 mean_displacement(std::span<const Vec2> position, std::size_t count);

/// Straight on by `step` [m] a period.
void straight_path(const Vec2& step, std::span<Vec2> displacement);
/// The mean acceleration of the last two changes goes on; stops instead of turning back.
void accelerating_path(std::span<const Vec2> position, std::span<Vec2> displacement);
/// What a change has come to after 1, 2, ... steps if it fades over `fade` of them (0: never).
struct FadedSteps : std::array<double, FlowMemory::kSteps> {
  FadedSteps(double fade);
};
/// Speed and direction change as between the last displacement and that `lag` before it; the change
/// fades. Nobody turns back; who stands doesn't turn.
void turning_path(std::span<const Vec2> position, std::size_t lag, const FadedSteps& fade,
                  std::span<Vec2> displacement);

}  // namespace sumogamma
