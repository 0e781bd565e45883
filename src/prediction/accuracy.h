#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "prediction/observed_scene.h"
#include "prediction/protocol.h"

namespace sumogamma {

/// Errors of one window [m].
struct WindowError {
  double average = 0;  ///< ADE: mean distance over the scored steps
  double final = 0;    ///< FDE: distance at the last scored step
};

/// Distances of a prediction from the truth. `predicted` starts one period after `window.frame`;
/// with protocol A the present counts as a first step without error, and one predicted step less is
/// used.
WindowError window_error(const Track& truth, int frame, std::span<const Vec2> predicted,
                         const Protocol& protocol);

/// Pairs of agents predicted from the same frame.
struct CollisionCount {
  std::int64_t pairs = 0;
  std::int64_t overlapping = 0;  ///< that overlap in any predicted step
  double rate() const {
    return pairs > 0 ? static_cast<double>(overlapping) / static_cast<double>(pairs) : 0.0;
  }
  void add(const CollisionCount& other) {
    pairs += other.pairs;
    overlapping += other.overlapping;
  }
};

/// COL of one forecast: pairs among `rows` whose boxes (bare, of their types) overlap at any of the
/// first `steps` predicted steps, by the separating axis test.
CollisionCount count_collisions(const AgentTypeTable& types, const ObservedScene& scene,
                                const Forecast& forecast, std::span<const std::size_t> rows,
                                std::size_t steps);

/// The same of what the agents then did, over the steps at which both still exist. `tracks` by row.
CollisionCount count_true_collisions(const AgentTypeTable& types, const TrackSet& set, int frame,
                                     std::span<const std::size_t> tracks, std::size_t steps);

/// Mean and its 95 % interval.
struct Interval {
  double mean = 0, low = 0, high = 0;
};

/// Mean over windows with a bootstrap interval over agents: windows of one agent are drawn
/// together, because they overlap. `agent` by window. Deterministic in the seed. Null for no
/// windows.
Interval bootstrap_mean(std::span<const double> value, std::span<const std::size_t> agent,
                        std::uint64_t seed, int draws = 400);

}  // namespace sumogamma
