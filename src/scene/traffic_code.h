#pragma once

#include "road/road_network.h"
#include "scene/road_state.h"

namespace sumogamma {

/// The law as data, where countries differ in it and the network doesn't say: a country is one
/// value.
struct TrafficCode {
  /// Who turns to the side that traffic keeps to may do so at red after a full stop, where the way
  /// is free (in the United States: Uniform Vehicle Code, section 11-202).
  bool turn_on_red = false;
};

/// May a vehicle go over a link at red once it has halted? Where its signal says so (SUMO's letter
/// s), and where the code has turns on red.
inline bool admits_turn_on_red(const TrafficCode& code, const RoadNetwork& network,
                               const Connection& link, Light light) {
  if (light == Light::StopThenGo) return true;
  const auto kerbside = network.left_hand ? TurnDirection::Left : TurnDirection::Right;
  return code.turn_on_red && light == Light::Red && link.direction == kerbside;
}

}  // namespace sumogamma
