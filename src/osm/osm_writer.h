#pragma once

#include <filesystem>

#include "osm/osm_map.h"
#include "osm/road_types.h"

namespace sumogamma::osm {

/// Writes the roads of a prepared map as OSM XML for netconvert: nodes in use, highway ways, turn
/// restrictions, sorted by id. Public transport is left out (nobody drives it here, and netconvert
/// warns about each incomplete line). `values` are written for what these ways have as highway.
/// Throws Error naming the file where it cannot be written.
void write_prepared_osm(const OsmMap& map, const std::filesystem::path& file,
                        const HighwayValues& values = {});

}  // namespace sumogamma::osm
