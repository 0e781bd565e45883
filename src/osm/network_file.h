#pragma once

#include <filesystem>
#include <pugixml.hpp>

#include "base/error.h"

namespace sumogamma::osm {

/// A SUMO network as it is written, for what read_sumo_net() doesn't keep. Throws Error where the
/// file is none.
inline pugi::xml_document load_network(const std::filesystem::path& file) {
  pugi::xml_document network;
  if (!network.load_file(file.c_str())) throw Error(file.string(), "not a network");
  return network;
}

/// Writes an XML file. Throws Error where it cannot be written.
inline void save_xml(const pugi::xml_document& document, const std::filesystem::path& file) {
  if (!document.save_file(file.c_str(), "    "))
    throw Error(file.string(), "cannot be written: is the disk full?");
}

}  // namespace sumogamma::osm
