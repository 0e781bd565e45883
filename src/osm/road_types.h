#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Value of the highway tag by way.
using HighwayValues = std::map<std::int64_t, std::string>;

/// netconvert 1.15 reads no tag of access but foot, bicycle and, to open a road, bus and psv. So
/// roads that are shut to some kinds of motor traffic, or open to others than their kind of road
/// is, get a type of their own, as their kind but for the classes ("residential.only_bus"), which
/// is written to a file of types. Returns the values of highway that name these types; the file is
/// written where there are none, too. `typemaps` are netconvert's files of types, later ones over
/// earlier ones. Throws Error where one can't be read or written.
HighwayValues write_road_types(const OsmMap& map,
                               const std::vector<std::filesystem::path>& typemaps,
                               const std::filesystem::path& file);

}  // namespace sumogamma::osm
