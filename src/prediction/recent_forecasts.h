#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace sumogamma {

/// What was foretold of each agent at its last frames, for who learns from how it came out. A
/// forecast is checked four times: when the steps 3, 6, 9 and 12 after it are seen.
template <typename Forecast>
class RecentForecasts {
 public:
  static constexpr std::size_t kSteps = 12, kEvery = 3, kChecks = kSteps / kEvery;

  /// The step, counted from 0, whose coming true a check looks at.
  static constexpr std::size_t step_of(std::size_t check) { return (check + 1) * kEvery - 1; }

  /// Room for the forecast of this frame, to be filled in whole. Once a frame and agent.
  Forecast& add(std::uint32_t agent, std::size_t kind) {
    History& history = history_[agent];
    Forecast& forecast = history.recent[history.next];
    history.next = (history.next + 1) % kSteps;
    history.count = std::min(history.count + 1, kSteps);
    history.kind = kind;
    history.seen = true;
    return forecast;
  }
  /// Calls with (kind, check, forecast) for each that has come to one of its checks, as the agent
  /// is seen a frame after its last forecast: before the next is added.
  template <typename Call>
  void for_due(std::uint32_t agent, Call&& call) const {
    const auto found = history_.find(agent);
    if (found == history_.end()) return;
    const History& history = found->second;
    for (std::size_t check = 0; check < kChecks; ++check) {
      const std::size_t age = (check + 1) * kEvery;
      if (age > history.count) break;
      call(history.kind, check, history.recent[(history.next + kSteps - age) % kSteps]);
    }
  }
  /// Forgets agents of whom nothing was added since the last call.
  void end_frame() {
    std::erase_if(history_, [](const auto& entry) { return !entry.second.seen; });
    for (auto& entry : history_) entry.second.seen = false;
  }
  void clear() { history_.clear(); }

 private:
  struct History {
    std::array<Forecast, kSteps> recent;  ///< a ring
    std::size_t count = 0, next = 0, kind = 0;
    bool seen = false;
  };

  std::unordered_map<std::uint32_t, History> history_;  ///< iterated only to drop entries
};

}  // namespace sumogamma
