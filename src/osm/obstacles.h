#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "osm/geo_projection.h"
#include "osm/osm_map.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// Writes buildings, walls, trees and posts as SUMO polygons in the network's coordinates: type
/// "building" (closed, filled; courtyards are joined to the outline by a slit), "barrier" (open
/// chain), and "furniture" (small closed ring). sumo-gui draws the file, read_obstacles() reads it.
///
/// Left out: what is not at street level (layer > 0, roofs, underground, indoor, min_level > 0).
/// What stands on a lane is cut there: a building over or into a lane becomes the open chain of
/// those of its walls that are off all lanes; people keep a metre on sidewalks and paths. Posts and
/// trees on a lane are left out.
///
/// Returns counts by name: "buildings", "buildings_opened", "barriers", "furniture",
/// "left_out_level", "left_out_on_lane". Throws Error where the file cannot be written.
std::map<std::string, long> write_obstacles(const OsmMap& map, const GeoProjection& projection,
                                            const RoadNetwork& road, const GeoBox& box,
                                            const std::filesystem::path& file, IssueLog& log);

}  // namespace sumogamma::osm
