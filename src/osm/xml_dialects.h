#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace sumogamma::osm {

/// What a text of OpenStreetMap XML has that libosmium knows nothing of, or refuses.
struct XmlDialect {
  bool deleted = false;       ///< objects that JOSM marked action='delete'
  bool located_refs = false;  ///< Overpass' "out geom": places in a way's list of nodes
  bool nested = false;        ///< elements within members ("out geom"), or centers ("out center")
  bool unversioned = false;   ///< a version other than 0.6, as OSMnx writes 1
  std::string remark;         ///< the server's word that its answer is not whole; "" for none

  bool any() const { return deleted || located_refs || nested || unversioned; }
};

/// Looks at a part of a text; parts may overlap. Elements are looked for by their names alone.
void look_at_xml(std::string_view part, XmlDialect& dialect);

/// The same map as plain OSM XML 0.6: without deleted objects, with the places of a way's nodes as
/// nodes where these are missing, and without elements and attributes that 0.6 doesn't have.
/// Counts "deleted_objects" and "nodes_from_ways". Throws Error naming the file where the text is
/// no XML, or of a version below 0.6.
std::string plain_osm_xml(const std::string& text, const std::filesystem::path& file,
                          std::map<std::string, long>& counts);

/// The first node whose place is none on the earth: "node 5 at latitude 91, longitude 9"; "" where
/// all are. The text is OSM XML.
std::string node_off_the_earth(const std::string& text);

}  // namespace sumogamma::osm
