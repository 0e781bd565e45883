#pragma once

#include <filesystem>
#include <string>

#include "road/road_network.h"

namespace sumogamma {

/// Reads a SUMO network (.net.xml, or gzipped .net.xml.gz).
/// Throws Error naming the file where it is missing, unreadable, not a network, or inconsistent.
RoadNetwork read_sumo_net(const std::filesystem::path& file);

/// Appends the polygons of a SUMO additional file (<poly>) as obstacles: type "building*" and
/// "furniture*" closed, "barrier*" open chains, anything else ignored. Throws Error as above.
void read_obstacles(const std::filesystem::path& file, RoadNetwork& network);

/// The whole file, inflated where it is gzip. Throws Error where it can't be read to its end.
std::string read_maybe_gzip(const std::filesystem::path& file);

}  // namespace sumogamma
