#pragma once

#include <vector>

#include "realism/recorded_scene.h"
#include "road/road_network.h"

namespace sumogamma {

/// Farther than this from the lanes of its route a point isn't on it [m].
inline constexpr double kOnRoute = 1.5;
/// Whose heading is farther from a lane's than this isn't going its way [degrees].
inline constexpr double kSameWay = 60.0;

/// A recorded agent's way over a network.
struct MatchedRoute {
  std::vector<EdgeId> edges;         ///< empty: none was found
  LaneId from = kNoLane;             ///< where it begins
  double from_along = 0;             ///< of its centre, on that lane's centreline [m]
  double to_along = 0;               ///< where it ends, on the last edge [m]
  std::size_t points = 0, near = 0;  ///< looked at, every half second; within kOnRoute of it
  EdgeId to = kNoEdge;               ///< the edge where it ends; others may follow for later
};

/// The route that most of the agent's points lie by: of those that lead from an edge at its first
/// points on the network (3 s) to one at its last, each the fastest. Lanes count that admit the
/// classes and run within kSameWay of its heading; who begins or ends on a junction is on the
/// edge before or behind it.
MatchedRoute match_route(const RoadNetwork& network, const RecordedAgent& agent,
                         VehicleClassMask classes);

/// Where somebody on foot walks from and to.
struct MatchedWalk {
  EdgeId from = kNoEdge, to = kNoEdge;  ///< kNoEdge: no sidewalk within reach
  double from_along = 0, to_along = 0;  ///< [m]
};

/// The lanes for people that are nearest to the agent's first and last place, at most 10 m away.
MatchedWalk match_walk(const RoadNetwork& network, const RecordedAgent& agent);

}  // namespace sumogamma
