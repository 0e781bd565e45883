#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "osm/geo_projection.h"
#include "osm/line_ways.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// Where lines are matched: the network, what its edges were made of, and the place.
struct LineGround {
  const RoadNetwork& road;
  /// Ways of the map by edge (ways_of_edges()).
  const std::map<std::string, std::set<std::int64_t>>& origins;
  const GeoProjection& projection;
  GeoBox place;                    ///< beyond which the network has no roads
  std::int64_t first_new_way = 0;  ///< ids from here on are pieces that repairs have cut off ways
};

/// Stretches of a line that a bus can drive in the network: edges that follow each other. A line
/// that leaves the place and comes back has several. Ways are found by the edges' origins, in the
/// direction of travel by their shapes, since repairs move, cut and join them; what is missing
/// between two of a line's edges (a way that was left out) is closed by the shortest way of up to
/// 300 m. Nothing leads back the road that it came by.
std::vector<std::vector<EdgeId>> line_routes(const LineGround& ground, const MapLine& line);

}  // namespace sumogamma::osm
