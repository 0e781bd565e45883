#include "realism/controls.h"

#include <algorithm>

#include "base/random.h"

namespace sumogamma {

namespace {

constexpr double kAccelerationSpread = 0.8, kTurnSpread = 0.08;  // [m/s^2], [rad/s]
constexpr double kAcceleratesFor = 3.0, kTurnsFor = 4.0;         // for so long [s]
constexpr double kTurningSpeed = 1.0;                            // [m/s]

/// One agent's way of a fan.
void draw_way(const MotionState& start, double acceleration, double turn, Poses& poses,
              std::size_t row) {
  const double speed = start.velocity.norm(), direction = heading_of(start.velocity);
  Vec2 position = start.position;
  for (std::size_t k = 0; k < Poses::kSteps; ++k) {
    const double time = kScoreStep * static_cast<double>(k);
    poses.position[row * Poses::kSteps + k] = position;
    const double turned = turn * std::min(time, kTurnsFor);
    poses.heading[row * Poses::kSteps + k] = start.heading + turned;
    const double now = std::max(0.0, speed + acceleration * std::min(time, kAcceleratesFor));
    position += kScoreStep * now * direction_of(direction + turned);
  }
}

}  // namespace

std::vector<Rollout> replay_log(const RecordedScene&, const ScoreWindow& window) {
  return {{window.log}};
}

std::vector<Rollout> stand_still(const RecordedScene& scene, const ScoreWindow& window) {
  Rollout rollout{Poses(window.agents.size())};
  for (std::size_t row = 0; row < window.agents.size(); ++row) {
    MotionState start = scene.agents[window.agents[row]].known_at(window.start);
    start.velocity = Vec2::Zero();
    draw_way(start, 0.0, 0.0, rollout.poses, row);
  }
  return {rollout};
}

std::vector<Rollout> keep_velocity(const RecordedScene& scene, const ScoreWindow& window) {
  Rollout rollout{Poses(window.agents.size())};
  for (std::size_t row = 0; row < window.agents.size(); ++row)
    draw_way(scene.agents[window.agents[row]].known_at(window.start), 0.0, 0.0, rollout.poses, row);
  return {rollout};
}

std::vector<Rollout> fan_out(const RecordedScene& scene, const ScoreWindow& window,
                             std::uint64_t seed, std::size_t count) {
  std::vector<Rollout> rollouts;
  const auto start = static_cast<std::uint64_t>(window.start);
  for (std::size_t r = 0; r < count; ++r) {
    rollouts.push_back({Poses(window.agents.size())});
    for (std::size_t row = 0; row < window.agents.size(); ++row) {
      const RecordedAgent& agent = scene.agents[window.agents[row]];
      const MotionState known = agent.known_at(window.start);
      const std::uint64_t draw = 2 * start;
      const double acceleration =
          kAccelerationSpread * random_normal(seed + r, agent.id, draw, Draw::ProcessNoise);
      const double turn =
          known.velocity.norm() > kTurningSpeed
              ? kTurnSpread * random_normal(seed + r, agent.id, draw + 1, Draw::ProcessNoise)
              : 0.0;
      draw_way(known, acceleration, turn, rollouts.back().poses, row);
    }
  }
  return rollouts;
}

}  // namespace sumogamma
