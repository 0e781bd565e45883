#pragma once

#include <memory>
#include <string>
#include <vector>

#include "road/path.h"
#include "scene/road_context.h"

namespace sumogamma {

/// The live part of the road: which way everybody follows, and what the signals show. A copyable
/// value like Scene.
struct RoadState {
  std::vector<std::shared_ptr<const Path>> paths;  ///< by PathId; null once its agent has left
  std::vector<std::string> signal_states;          ///< by SignalId, one letter a link as in SUMO

  const Path* path(PathId id) const {
    return id == kNoPath ? nullptr : paths[static_cast<std::size_t>(id)].get();
  }
  /// The letter that a link shows now: 'O' (unsignalled) where it has no signal or its state isn't
  /// known yet.
  char signal(const Connection& connection) const {
    if (connection.signal == kNoSignal || connection.signal_link < 0) return 'O';
    const std::size_t index = index_of(connection.signal);
    const auto link = static_cast<std::size_t>(connection.signal_link);
    if (index >= signal_states.size() || link >= signal_states[index].size()) return 'O';
    return signal_states[index][link];
  }
};

inline bool is_red(char signal) { return signal == 'r' || signal == 'u'; }
inline bool is_amber(char signal) { return signal == 'y' || signal == 'Y'; }

}  // namespace sumogamma
