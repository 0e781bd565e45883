#pragma once

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "model/model.h"
#include "realism/free_run.h"
#include "realism/window_cast.h"

namespace sumogamma {

/// GAMMA in closed loop on open ground: everybody, whoever came when, is moved by the model (Eq. 7,
/// guard) in steps of 0.05 s, without a map and its rules.
///
/// Given, beside the type and the box: what was seen of somebody in the last second before the
/// window (RecordedAgent::known_at); who comes later, with place, velocity and time of the
/// recording; when somebody leaves; and everybody's destination, the last place where the recording
/// has it. Who reaches it goes on in the direction in which it was last seen to move. Drawn from
/// seed and agent: responsibility and attention as a run draws them (draw_behavior), and the
/// desired speed, see desired_speed.
class ClosedLoop {
 public:
  /// `behavior`: how types drive, by name.
  ClosedLoop(const RecordedScene& scene, const ModelOptions& options,
             const AgentTypeTable& behavior, Workers& workers);

  /// One rollout of a window.
  Rollout drive(const ScoreWindow& window, std::uint64_t seed, EntryCounts& entries) const;
  /// All of the recording.
  FreeRun drive_freely(std::uint64_t seed) const;

 private:
  void complete(const RecordedAgent& who, const MotionState& state, std::uint64_t seed,
                AgentState& row) const;
  const RecordedScene& scene_;
  Workers& workers_;
  Model model_;
};

/// How fast somebody wants to go who has this speed now [m/s]: from that up to what its type
/// prefers, at most 30 km/h, mostly near what it does now (the share of the way up is the square of
/// a uniform draw); all by a normal factor with a deviation of 0.15. Assumed: what nobody told is
/// how fast somebody would go who has just been held up. A pure function of type, speed, seed and
/// id.
double desired_speed(const AgentType& type, double speed, std::uint64_t seed, std::uint32_t id);

}  // namespace sumogamma
