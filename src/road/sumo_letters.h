#pragma once

#include "road/road_network.h"

namespace sumogamma {

// What the letters of SUMO's networks and signals mean (SUMO pages Networks/SUMO_Road_Networks and
// Simulation/Traffic_Lights). Besides this, only who reads whole signal programs knows letters:
// demand/lane_load and osm/repairs/signal_offsets.

/// What a signal shows to a link.
enum class Light : std::uint8_t {
  None,  ///< no signal, or it is off or not known yet
  Red,   ///< with amber, too
  Amber,
  Green,       ///< who turns gives way, or everybody where it blinks
  GreenFirst,  ///< nobody who crosses goes first
  StopThenGo,  ///< red, but who has halted may go where the way is free
};

/// Of `dir`; straight where the letter is none of SUMO's.
TurnDirection direction_from_letter(char letter);
/// Of `state`; Other where the letter is none of a link without a signal.
LinkPriority priority_from_letter(char letter);
/// Of a signal's state string.
Light light_from_letter(char letter);

}  // namespace sumogamma
