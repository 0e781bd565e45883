#pragma once

#include <cstdint>
#include <vector>

#include "realism/likelihood.h"

namespace sumogamma {

/// What the recording itself does: the highest that a score can come to, since its rollout can't be
/// nearer to it.
std::vector<Rollout> replay_log(const RecordedScene& scene, const ScoreWindow& window);

/// Everybody stands where it is at the beginning.
std::vector<Rollout> stand_still(const RecordedScene& scene, const ScoreWindow& window);

/// Everybody goes on as it did in the last second before the window.
std::vector<Rollout> keep_velocity(const RecordedScene& scene, const ScoreWindow& window);

/// As keep_velocity, `count` times, each agent with an acceleration (normal, sd 0.8 m/s^2, for 3 s,
/// never backwards) and, where it goes faster than 1 m/s, a turn (normal, sd 0.08 rad/s, for 4 s)
/// drawn from seed, agent and window. Nobody knows of the others.
std::vector<Rollout> fan_out(const RecordedScene& scene, const ScoreWindow& window,
                             std::uint64_t seed, std::size_t count);

}  // namespace sumogamma
