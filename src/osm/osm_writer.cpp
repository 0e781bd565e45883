#include "osm/osm_writer.h"

#include <cstdio>
#include <pugixml.hpp>
#include <set>

#include "base/error.h"

namespace sumogamma::osm {
namespace {

/// 7 decimals: OSM's own resolution, about a centimetre.
std::string coordinate(double degrees) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7f", degrees);
  return text;
}

void append_tags(pugi::xml_node element, const Tags& tags) {
  for (const auto& [key, value] : tags) {
    if (key == "public_transport" || key.starts_with("route_ref")) continue;
    pugi::xml_node child = element.append_child("tag");
    child.append_attribute("k") = key.c_str();
    child.append_attribute("v") = value.c_str();
  }
}

/// Of a node, what says something about traffic at it.
Tags traffic_tags(const Tags& tags) {
  Tags kept;
  for (const auto& [key, value] : tags) {
    const bool stop =
        key == "highway" && value != "bus_stop" && value != "platform" && value != "street_lamp";
    if (stop || key == "crossing" || key.starts_with("crossing:") ||
        key.starts_with("traffic_signals"))
      kept.emplace(key, value);
  }
  return kept;
}

}  // namespace

void write_prepared_osm(const OsmMap& map, const std::filesystem::path& file,
                        const HighwayValues& values) {
  std::set<std::int64_t> used;
  for (const MapWay& way : map.ways)
    if (way.tags.contains("highway")) used.insert(way.nodes.begin(), way.nodes.end());

  pugi::xml_document document;
  pugi::xml_node root = document.append_child("osm");
  root.append_attribute("version") = "0.6";
  root.append_attribute("generator") = "sumo-gamma";
  for (const std::int64_t id : used) {
    const MapNode& node = map.nodes.at(id);
    pugi::xml_node element = root.append_child("node");
    element.append_attribute("id") = static_cast<long long>(id);
    element.append_attribute("lat") = coordinate(node.place.lat).c_str();
    element.append_attribute("lon") = coordinate(node.place.lon).c_str();
    append_tags(element, traffic_tags(node.tags));
  }
  std::map<std::int64_t, const MapWay*> by_id;
  for (const MapWay& way : map.ways)
    if (way.tags.contains("highway")) by_id[way.id] = &way;
  for (const auto& [id, way] : by_id) {
    pugi::xml_node element = root.append_child("way");
    element.append_attribute("id") = static_cast<long long>(id);
    for (const std::int64_t ref : way->nodes)
      element.append_child("nd").append_attribute("ref") = static_cast<long long>(ref);
    Tags tags = way->tags;
    if (const auto value = values.find(id); value != values.end()) tags["highway"] = value->second;
    append_tags(element, tags);
  }
  for (const MapRelation& relation : map.relations) {
    pugi::xml_node element = root.append_child("relation");
    element.append_attribute("id") = static_cast<long long>(relation.id);
    for (const MapMember& member : relation.members) {
      pugi::xml_node child = element.append_child("member");
      child.append_attribute("type") = member.type == 'n'   ? "node"
                                       : member.type == 'w' ? "way"
                                                            : "relation";
      child.append_attribute("ref") = static_cast<long long>(member.ref);
      child.append_attribute("role") = member.role.c_str();
    }
    append_tags(element, relation.tags);
  }
  if (!document.save_file(file.c_str(), " "))
    throw Error(file.string(), "cannot be written: is the disk full?");
}

}  // namespace sumogamma::osm
