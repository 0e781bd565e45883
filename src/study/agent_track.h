#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace sumogamma {

/// What a monitor remembers of each agent alive, kept in step with the scene's rows: O(agents) a
/// tick, and an agent that is gone is forgotten.
template <typename State>
class AgentTrack {
 public:
  /// Matches the states to `ids` (ascending). New agents get a default State; leave(id, state) is
  /// called for those gone.
  template <typename Leave>
  void match(std::span<const AgentId> ids, Leave&& leave) {
    if (std::equal(ids.begin(), ids.end(), ids_.begin(), ids_.end())) return;
    next_.clear();
    next_.resize(ids.size());
    std::size_t old = 0;
    for (std::size_t row = 0; row < ids.size(); ++row) {
      for (; old < ids_.size() && ids_[old] < ids[row]; ++old) leave(ids_[old], states_[old]);
      if (old < ids_.size() && ids_[old] == ids[row]) next_[row] = std::move(states_[old++]);
    }
    for (; old < ids_.size(); ++old) leave(ids_[old], states_[old]);
    states_.swap(next_);
    ids_.assign(ids.begin(), ids.end());
  }
  void match(std::span<const AgentId> ids) {
    match(ids, [](AgentId, State&) {});
  }

  State& operator[](std::size_t row) { return states_[row]; }
  std::span<const AgentId> ids() const { return ids_; }
  std::span<const State> states() const { return states_; }

 private:
  std::vector<AgentId> ids_;
  std::vector<State> states_, next_;
};

}  // namespace sumogamma
