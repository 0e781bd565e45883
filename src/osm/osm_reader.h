#pragma once

#include <filesystem>
#include <optional>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Reads an extract: .osm, .osm.gz, .osm.bz2, .osm.pbf (or .pbf, .xml), objects in any order.
///
/// Keeps the ways with a highway, building, barrier or area tag, the nodes on them, the tagged
/// nodes that matter (signals, crossings, trees, bollards ...), turn restrictions, lines of public
/// transport and where they halt, and the areas that osmium assembles from closed ways and
/// multipolygons. Objects that JOSM marked action='delete' and those with visible='false' are left
/// out; negative ids of unsaved objects become positive, since SUMO writes a reverse edge with "-".
/// With `keep`, only ways and nodes that reach into that box are kept (whole ways).
///
/// Throws Error naming the file: absent, a folder, not OSM, cut short, damaged, empty.
OsmMap read_osm(const std::filesystem::path& file,
                const std::optional<GeoBox>& keep = std::nullopt);

/// Libosmium's version, for `sumo-gamma version` and import.json.
std::string osmium_version();

}  // namespace sumogamma::osm
