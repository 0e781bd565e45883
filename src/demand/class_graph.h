#pragma once

#include <limits>
#include <vector>

#include "road/road_network.h"

namespace sumogamma {

inline constexpr double kUnreachable = std::numeric_limits<double>::infinity();

/// What one vehicle class sees of the network.
struct ClassGraph {
  std::vector<std::size_t> edges;              ///< usable, by index in the network
  std::vector<bool> usable;                    ///< the same, by index
  std::vector<std::vector<std::size_t>> next;  ///< by network edge: edges that follow
  std::vector<int> entries;  ///< by network edge: how many lead into it, turn-arounds left out
  std::vector<double> length, speed;  ///< by network edge [m], [m/s]

  /// Nothing leads to it or on from it: a road that crosses the map, or a rest of one at its edge.
  bool stands_alone(std::size_t edge) const { return entries[edge] == 0 && next[edge].empty(); }
};

/// Edges and ways on for a class. Buses and lorries keep to streets that are made for them, unless
/// these are next to none.
ClassGraph class_graph(const RoadNetwork& road, VehicleClassMask mask);

/// Metres from the start of the origin to the end of each edge; infinity where there is no way
/// (Dijkstra).
std::vector<double> distances_from(const ClassGraph& graph, std::size_t origin);

}  // namespace sumogamma
