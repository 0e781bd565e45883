#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>

#include "road/road_network.h"

namespace sumogamma::osm {

/// A network as netconvert made it: the elements of its file, and what they mean
/// (read_net_elements()).
struct NetworkFile {
  pugi::xml_document document;
  RoadNetwork road;

  pugi::xml_node net() const { return document.child("net"); }
};

/// Throws Error where the file is no network.
NetworkFile load_network(const std::filesystem::path& file);

/// The ways of the map that each edge of a network was made of, as --output.original-names says.
std::map<std::string, std::set<std::int64_t>> ways_of_edges(const pugi::xml_node& net);

/// The points of an element's shape [m], without heights; none where it has no shape, those before
/// what is none.
std::vector<Vec2> shape_of(const pugi::xml_node& element);

/// Writes an XML file. Throws Error where it cannot be written.
void save_xml(const pugi::xml_document& document, const std::filesystem::path& file);

}  // namespace sumogamma::osm
