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
/// The ground of lanes is cut out of what stands on it (LaneClearing), so that nothing solid is
/// ever on a lane; a building with a passage becomes two. Posts and trees on a lane are left out.
///
/// Returns counts by name: "buildings", "buildings_cut", "barriers", "furniture", "left_out_level",
/// "left_out_on_lane". Throws Error where the file cannot be written.
std::map<std::string, long> write_obstacles(const OsmMap& map, const GeoProjection& projection,
                                            const RoadNetwork& road, const GeoBox& box,
                                            const std::filesystem::path& file, IssueLog& log);

/// How many of a network's obstacles stood on the ground of its lanes.
struct ClearedObstacles {
  std::size_t cut = 0, left_out = 0;
};

/// Cuts the ground of the network's lanes (LaneClearing) out of its obstacles, as write_obstacles()
/// does: for polygons that were drawn without a look at the lanes, where houses stand on sidewalks
/// and leave nobody through. Posts and trees on a lane are left out.
ClearedObstacles clear_lanes(RoadNetwork& road);

}  // namespace sumogamma::osm
