#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "road/road_network.h"

namespace pugi {
class xml_document;
}

namespace sumogamma {

/// Reads a SUMO network (.net.xml, or gzipped .net.xml.gz), with the help of workers.
/// Throws Error naming the file where it is missing, unreadable, not a network, or inconsistent.
RoadNetwork read_sumo_net(const std::filesystem::path& file, Workers& workers);
inline RoadNetwork read_sumo_net(const std::filesystem::path& file) {
  Workers alone;
  return read_sumo_net(file, alone);
}

/// The same of a network that is parsed already; `file` names it where it is inconsistent.
RoadNetwork read_sumo_net(const pugi::xml_document& document, const std::filesystem::path& file,
                          Workers& workers);
inline RoadNetwork read_sumo_net(const pugi::xml_document& document,
                                 const std::filesystem::path& file) {
  Workers alone;
  return read_sumo_net(document, file, alone);
}

/// Its elements alone, without what is worked out from them: stop lines set back, signals within
/// junctions, rooms of junctions, overpasses. For who looks at networks that nobody drives on.
RoadNetwork read_net_elements(const pugi::xml_document& document,
                              const std::filesystem::path& file);

/// Appends the polygons of a SUMO additional file (<poly>) as obstacles: type "building*" and
/// "furniture*" closed, "barrier*" open chains, anything else ignored. Throws Error as above.
void read_obstacles(const std::filesystem::path& file, RoadNetwork& network);

/// Rings of the polygons of a SUMO additional file by id, of any type, in the network's metres
/// (those in longitude and latitude are left out). Throws Error as above.
std::map<std::string, std::vector<Vec2>> read_polygons(const std::filesystem::path& file);

/// The whole file, inflated where it is gzip. Throws Error where it can't be read to its end.
std::string read_maybe_gzip(const std::filesystem::path& file);

}  // namespace sumogamma
