#pragma once

#include <filesystem>
#include <string>

namespace sumogamma::osm {

/// What an extract is by its first bytes, whatever its name: "osm", "osm.gz", "osm.bz2" or "pbf",
/// as libosmium names them. Throws Error naming the file where it is something else, and says what:
/// a web page, JSON, an archive, a network of SUMO's.
std::string kind_of_file(const std::filesystem::path& file);

}  // namespace sumogamma::osm
