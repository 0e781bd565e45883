#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// Reach of the flow prior.
struct FlowKernel {
  double distance = 1.5;  ///< scale over which places are alike [m]
  double speed = 0.3;     ///< scale over which velocities are alike [m/s]
  double prior = 4;       ///< weight of "no correction", in predecessors at the very same state
};

/// The intention that the place suggests: how those who were here before, moving alike, departed
/// from what was predicted of them. A kernel regression (Nadaraya-Watson with a prior weight on
/// zero) over the residuals of past predictions in the same recording. It is fed online and never
/// knows more than what has been seen by then: the residual of a prediction three steps ago ends at
/// three steps.
class FlowMemory {
 public:
  static constexpr std::size_t kSteps = 12;
  /// States farther apart than this many scales have nothing to say [squared].
  static constexpr double kReach = 9.0;

  /// A cell of 2 m keeps at most `cell_capacity` predictions, the oldest give way: cost and memory
  /// stay bounded in a long run.
  explicit FlowMemory(std::size_t cell_capacity = 384) : cell_capacity_(cell_capacity) {}

  /// What an agent at `position` [m] with `velocity` [m/s] was predicted to do: displacements at
  /// the next steps [m]. Call once per agent and frame, agents in any order.
  void remember(std::uint32_t agent, const Vec2& position, const Vec2& velocity,
                std::span<const Vec2> predicted);

  /// The agent was seen at `position` in the next frame: completes what was remembered of it. Call
  /// before `remember` of that frame.
  void resolve(std::uint32_t agent, const Vec2& position);

  /// Agents that were neither seen nor remembered since the last call are forgotten as active.
  void end_frame();

  /// Expected departure from the prediction at the next steps [m], from agents other than `agent`;
  /// null where nobody was like this.
  std::array<Vec2, kSteps> correction(std::uint32_t agent, const Vec2& position,
                                      const Vec2& velocity, const FlowKernel& kernel) const;

  /// As new.
  void clear() {
    samples_.clear();
    cells_.clear();
    active_.clear();
  }

  std::size_t size() const { return samples_.size(); }

 private:
  static constexpr double kCell = 2.0;  // [m]

  struct Sample {
    Vec2 position, velocity;
    std::uint32_t agent = 0;
    std::uint32_t known = 0;  ///< steps whose residual is known
    std::array<Vec2, kSteps> residual;
  };
  struct Cell {
    std::vector<std::uint32_t> samples;
    std::size_t next = 0;
  };
  struct Active {
    std::array<std::uint32_t, kSteps> recent{};  ///< samples, newest first
    std::uint32_t count = 0;
    bool seen = false;
  };

  static std::int64_t key_of(std::int64_t x, std::int64_t y) {
    return (x << 32) ^ (y & 0xffffffff);
  }
  std::uint32_t place_for(const Vec2& position);

  std::size_t cell_capacity_;
  std::vector<Sample> samples_;
  std::unordered_map<std::int64_t, Cell> cells_;      ///< looked up, never iterated
  std::unordered_map<std::uint32_t, Active> active_;  ///< likewise, but for dropping entries
};

}  // namespace sumogamma
