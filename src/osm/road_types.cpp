#include "osm/road_types.h"

#include <algorithm>
#include <iterator>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "base/error.h"
#include "osm/mode_access.h"
#include "osm/network_file.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

using Words = std::set<std::string>;

/// SUMO 1.15's vehicle classes (page Simulation/VehiclePermissions).
const Words& all_classes() {
  static const Words kClasses = {
      "private",    "emergency", "authority", "army",     "vip",          "pedestrian", "passenger",
      "hov",        "taxi",      "bus",       "coach",    "delivery",     "truck",      "trailer",
      "motorcycle", "moped",     "bicycle",   "evehicle", "tram",         "rail_urban", "rail",
      "rail_fast",  "ship",      "custom1",   "custom2",  "rail_electric"};
  return kClasses;
}

Words words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::string joined(const auto& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// Attributes by type; of one that stands in several files the later ones hold.
using TypeAttributes = std::map<std::string, std::map<std::string, std::string>>;

TypeAttributes read_types(const std::vector<std::filesystem::path>& typemaps) {
  TypeAttributes types;
  for (const std::filesystem::path& file : typemaps) {
    pugi::xml_document document;
    if (!document.load_file(file.c_str()))
      throw Error(file.string(), "not a file of road types: is SUMO installed whole?");
    for (const pugi::xml_node type : document.child("types").children("type")) {
      auto& attributes = types[type.attribute("id").value()];
      const bool allow = type.attribute("allow"), disallow = type.attribute("disallow");
      if (allow || disallow) {
        attributes.erase("allow");
        attributes.erase("disallow");
      }
      for (const pugi::xml_attribute attribute : type.attributes())
        attributes[attribute.name()] = attribute.value();
    }
  }
  return types;
}

Words allowed_by(const std::map<std::string, std::string>& type) {
  if (const auto allow = type.find("allow"); allow != type.end()) return words_of(allow->second);
  Words allowed = all_classes();
  if (const auto shut = type.find("disallow"); shut != type.end())
    for (const std::string& name : words_of(shut->second)) allowed.erase(name);
  return allowed;
}

Words allowed_by(Words classes, const ModeAccess& access) {
  for (const std::string& mode : access.closed)
    for (const std::string& name : classes_of_mode(mode)) classes.erase(name);
  for (const std::string& mode : access.opened)
    for (const std::string& name : classes_of_mode(mode)) classes.insert(name);
  return classes;
}

/// "only_bus_taxi" or "not_hgv", whichever is shorter; modes that a tag opens are told where the
/// kind of road shuts them out.
std::string suffix_of(const Words& before, const ModeAccess& access) {
  const Words closed(access.closed.begin(), access.closed.end());
  std::vector<std::string> open;
  for (const std::string& mode : motor_modes())
    if (!closed.contains(mode)) open.push_back(mode);
  if (open.size() < closed.size()) return "only_" + joined(open, "_");
  std::vector<std::string> also;
  for (const std::string& mode : access.opened)
    if (!before.contains(classes_of_mode(mode)[0])) also.push_back(mode);
  std::string suffix = closed.empty() ? "" : "not_" + joined(access.closed, "_");
  if (!also.empty()) suffix += (suffix.empty() ? "with_" : "_with_") + joined(also, "_");
  return suffix;
}

}  // namespace

HighwayValues write_road_types(const OsmMap& map,
                               const std::vector<std::filesystem::path>& typemaps,
                               const std::filesystem::path& file) {
  const TypeAttributes known = read_types(typemaps);
  std::map<std::string, std::map<std::string, std::string>> made;
  HighwayValues values;
  for (const MapWay& way : map.ways) {
    if (!is_car_way(way)) continue;
    const std::string& highway = tag(way.tags, "highway");
    const auto base = known.find("highway." + highway);
    if (base == known.end()) continue;
    const ModeAccess access = mode_access(way.tags);
    const Words before = allowed_by(base->second), after = allowed_by(before, access);
    if (before == after) continue;
    const std::string value = highway + "." + suffix_of(before, access);
    values[way.id] = value;
    auto& type = made["highway." + value];
    type = base->second;
    type.erase("disallow");
    type["allow"] = joined(after, " ");
    type["id"] = "highway." + value;
  }
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("types");
  for (const auto& [id, attributes] : made) {
    pugi::xml_node type = root.append_child("type");
    for (const auto& [name, value] : attributes)
      type.append_attribute(name.c_str()) = value.c_str();
  }
  save_xml(document, file);
  return values;
}

}  // namespace sumogamma::osm
