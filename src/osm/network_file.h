#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "base/error.h"

namespace sumogamma::osm {

/// A SUMO network as it is written, for what read_sumo_net() doesn't keep. Throws Error where the
/// file is none.
inline pugi::xml_document load_network(const std::filesystem::path& file) {
  pugi::xml_document network;
  if (!network.load_file(file.c_str())) throw Error(file.string(), "not a network");
  return network;
}

/// The ways of the map that each edge of a network was made of, as --output.original-names says.
inline std::map<std::string, std::set<std::int64_t>> ways_of_edges(
    const pugi::xml_document& network) {
  std::map<std::string, std::set<std::int64_t>> ways;
  for (const pugi::xml_node edge : network.child("net").children("edge")) {
    if (edge.attribute("function")) continue;
    std::set<std::int64_t>& made_of = ways[edge.attribute("id").value()];
    for (const pugi::xml_node lane : edge.children("lane"))
      for (const pugi::xml_node param : lane.children("param")) {
        if (std::string_view(param.attribute("key").value()) != "origId") continue;
        std::istringstream origins(param.attribute("value").value());
        for (std::int64_t way = 0; origins >> way;) made_of.insert(way);
      }
  }
  return ways;
}

/// Writes an XML file. Throws Error where it cannot be written.
inline void save_xml(const pugi::xml_document& document, const std::filesystem::path& file) {
  if (!document.save_file(file.c_str(), "    "))
    throw Error(file.string(), "cannot be written: is the disk full?");
}

}  // namespace sumogamma::osm
