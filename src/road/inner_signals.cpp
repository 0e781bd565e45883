#include "road/inner_signals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "road/conflict_zones.h"

namespace sumogamma {

namespace {

constexpr double kMostRoad = 15.0;  ///< two cars, or a bus, and the gaps between them [m]

/// Do ways of vehicles from different roads meet on a junction? At a signal for people on foot they
/// don't.
bool roads_cross(const RoadNetwork& network, const Junction& junction) {
  const std::vector<ConnectionId> links = driven_links(network, junction);
  const auto edge_of = [&](ConnectionId id) {
    return network.lane(network.connection(id).from).edge;
  };
  const auto meet = [&](ConnectionId a, ConnectionId b) {
    const auto own = static_cast<std::size_t>(network.connection(a).junction_link);
    const auto other = static_cast<std::size_t>(network.connection(b).junction_link);
    return own < junction.requests.size() && other < junction.requests[own].conflicts.size() &&
           junction.requests[own].conflicts[other];
  };
  return std::any_of(links.begin(), links.end(), [&](ConnectionId a) {
    return std::any_of(links.begin(), links.end(),
                       [&](ConnectionId b) { return edge_of(a) != edge_of(b) && meet(a, b); });
  });
}

/// Least way to the end of a short road from the stop lines before it, where it is reached over
/// signals of such junctions alone [m]; 0 of another.
double storage_of(const RoadNetwork& network, const Edge& edge, const std::vector<bool>& crosses) {
  double length = 0.0, storage = std::numeric_limits<double>::infinity();
  for (const LaneId id : edge.lanes) {
    const Lane& lane = network.lane(id);
    length = std::max(length, lane.centerline.length());
    for (const ConnectionId link : lane.incoming) {
      if (!is_driven(network, link)) continue;
      const Connection& connection = network.connection(link);
      if (connection.signal == kNoSignal || connection.junction == kNoJunction ||
          !crosses[index_of(connection.junction)])
        return 0.0;
      storage = std::min(storage, link_geometry(network, link).length() + lane.centerline.length());
    }
  }
  return std::isfinite(storage) && length <= kMostRoad ? storage : 0.0;
}

}  // namespace

void find_inner_signals(RoadNetwork& network) {
  std::vector<bool> crosses;
  for (const Junction& junction : network.junctions)
    crosses.push_back(roads_cross(network, junction));
  for (std::size_t i = 0; i < network.connections.size(); ++i) {
    Connection& connection = network.connections[i];
    if (connection.signal == kNoSignal || connection.junction == kNoJunction ||
        !is_driven(network, static_cast<ConnectionId>(i)) ||
        !crosses[index_of(connection.junction)])
      continue;
    const Edge& edge = network.edge(network.lane(connection.from).edge);
    if (edge.kind == LaneKind::Normal) connection.storage = storage_of(network, edge, crosses);
  }
}

}  // namespace sumogamma
