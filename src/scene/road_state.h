#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "road/path.h"
#include "road/sumo_letters.h"
#include "scene/road_context.h"

namespace sumogamma {

/// The live part of the road: which way everybody follows, and what the signals show. A copyable
/// value like Scene.
struct RoadState {
  std::vector<std::shared_ptr<const Path>> paths;  ///< by PathId; null once its agent has left
  std::vector<std::string> signal_states;          ///< by SignalId, one letter a link as in SUMO
  std::vector<double> signal_since;                ///< by SignalId, when it last changed [s]
  std::vector<double> amber_until;  ///< by SignalId, when it ends where one shows amber [s]; may be
                                    ///< shorter than the signals: not known

  const Path* path(PathId id) const {
    return id == kNoPath ? nullptr : paths[static_cast<std::size_t>(id)].get();
  }
  /// What a link shows now: None where it has no signal or its state isn't known yet.
  Light signal(const Connection& connection) const {
    if (connection.signal == kNoSignal || connection.signal_link < 0) return Light::None;
    const std::size_t index = index_of(connection.signal);
    const auto link = static_cast<std::size_t>(connection.signal_link);
    if (index >= signal_states.size() || link >= signal_states[index].size()) return Light::None;
    return light_from_letter(signal_states[index][link]);
  }
};

/// When the signal of a connection last changed [s]; `now` where that isn't known.
inline double signal_since(const RoadState& road, const Connection& connection, double now) {
  const bool known =
      connection.signal != kNoSignal && index_of(connection.signal) < road.signal_since.size();
  return known ? road.signal_since[index_of(connection.signal)] : now;
}

/// When the amber of a connection's signal ends [s]; infinite where that isn't known.
inline double amber_until(const RoadState& road, const Connection& connection) {
  const bool known =
      connection.signal != kNoSignal && index_of(connection.signal) < road.amber_until.size();
  return known ? road.amber_until[index_of(connection.signal)]
               : std::numeric_limits<double>::infinity();
}

inline bool is_red(Light light) { return light == Light::Red || light == Light::StopThenGo; }
inline bool is_amber(Light light) { return light == Light::Amber; }

/// Does nobody who crosses a link now go first there? `light`: what it shows.
inline bool has_right_of_way(const Connection& connection, Light light) {
  return light == Light::GreenFirst ||
         (light == Light::None && connection.priority == LinkPriority::Major);
}

}  // namespace sumogamma
