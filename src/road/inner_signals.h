#pragma once

#include "road/road_network.h"

namespace sumogamma {

/// Sets Connection::storage of every link at an inner signal: one junction of dual carriageways is
/// drawn as several, each with a signal of its own, and between two of them there is room for two
/// cars at the most. An inner signal is where roads cross; its road is that short and is reached
/// over signals alone, of junctions where roads cross, too. Who got green there clears the
/// junction: red at the inner one is a line to give way at.
void find_inner_signals(RoadNetwork& network);

}  // namespace sumogamma
