#pragma once

#include <vector>

#include "road/road_network.h"

namespace sumogamma {

/// Which link a lane inside a junction is a piece of.
struct LinkPiece {
  ConnectionId link = kNoConnection;
  double before = 0;  ///< of the link, before this lane of it [m]
};

/// By LaneId; no link for lanes that are none's piece.
std::vector<LinkPiece> find_link_pieces(const RoadNetwork& network);

}  // namespace sumogamma
