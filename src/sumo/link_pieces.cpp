#include "sumo/link_pieces.h"

namespace sumogamma {

std::vector<LinkPiece> find_link_pieces(const RoadNetwork& network) {
  std::vector<LinkPiece> pieces(network.lanes.size());
  for (std::size_t i = 0; i < network.connections.size(); ++i) {
    const Connection& connection = network.connections[i];
    if (connection.from == kNoLane || network.lane(connection.from).kind != LaneKind::Normal)
      continue;
    double before = 0.0;
    for (LaneId lane = connection.via; lane != kNoLane;) {
      LinkPiece& piece = pieces[index_of(lane)];
      if (piece.link != kNoConnection) break;
      piece = {static_cast<ConnectionId>(i), before};
      before += network.lane(lane).centerline.length();
      LaneId next = kNoLane;
      for (const ConnectionId onward : network.lane(lane).outgoing)
        if (network.connection(onward).to == connection.to) next = network.connection(onward).via;
      lane = next;
    }
  }
  return pieces;
}

}  // namespace sumogamma
