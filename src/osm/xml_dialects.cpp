#include "osm/xml_dialects.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "base/error.h"

namespace sumogamma::osm {
namespace {

bool has(std::string_view text, std::string_view word) {
  return text.find(word) != std::string_view::npos;
}

/// Does the first such element have the attribute?
bool has_attribute(std::string_view text, std::string_view element, std::string_view attribute) {
  const std::size_t begin = text.find(element);
  if (begin == std::string_view::npos) return false;
  return has(text.substr(begin, text.find('>', begin) - begin), attribute);
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_place(pugi::xml_node node) {
  const auto lat = number(node.attribute("lat").value()),
             lon = number(node.attribute("lon").value());
  return lat && lon && std::abs(*lat) <= 90 && std::abs(*lon) <= 180;
}

void copy_attributes(pugi::xml_node from, const std::vector<const char*>& names,
                     pugi::xml_node to) {
  for (const char* name : names)
    if (const pugi::xml_attribute attribute = from.attribute(name))
      to.append_attribute(name) = attribute.value();
}

void copy_children(pugi::xml_node from, const char* element, const std::vector<const char*>& names,
                   pugi::xml_node to) {
  for (const pugi::xml_node child : from.children(element))
    copy_attributes(child, names, to.append_child(element));
}

/// Nodes that only the ways tell the places of.
void append_located_refs(pugi::xml_node root, pugi::xml_node plain,
                         std::map<std::string, long>& counts) {
  std::set<std::string> known;
  for (const pugi::xml_node node : root.children("node"))
    known.insert(node.attribute("id").value());
  for (const pugi::xml_node way : root.children("way"))
    for (const pugi::xml_node ref : way.children("nd")) {
      if (!ref.attribute("lat") || !ref.attribute("ref") ||
          !known.insert(ref.attribute("ref").value()).second)
        continue;
      pugi::xml_node node = plain.append_child("node");
      node.append_attribute("id") = ref.attribute("ref").value();
      copy_attributes(ref, {"lat", "lon"}, node);
      ++counts["nodes_from_ways"];
    }
}

}  // namespace

void look_at_xml(std::string_view part, XmlDialect& dialect) {
  dialect.deleted =
      dialect.deleted || has(part, "action='delete'") || has(part, "action=\"delete\"");
  dialect.nested = dialect.nested || has(part, "</member>") || has(part, "<center");
  dialect.located_refs = dialect.located_refs || has_attribute(part, "<nd ", "lat=");
  if (has_attribute(part, "<osm", "version="))
    dialect.unversioned = !has_attribute(part, "<osm", "version=\"0.6\"") &&
                          !has_attribute(part, "<osm", "version='0.6'");
  const std::size_t begin = part.find("<remark>"), end = part.find("</remark>");
  if (begin != std::string_view::npos && end != std::string_view::npos && begin + 8 < end)
    dialect.remark = part.substr(begin + 8, std::min<std::size_t>(end - begin - 8, 200));
}

std::string plain_osm_xml(const std::string& text, const std::filesystem::path& file,
                          std::map<std::string, long>& counts) {
  pugi::xml_document document, written;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    throw Error(file.string(), std::string("not well-formed XML: ") + parsed.description());
  const pugi::xml_node root = document.child("osm");
  const std::string version = root.attribute("version").value();
  if (version.starts_with("0.") && version != "0.6")
    throw Error(file.string(), "is OpenStreetMap XML of version " + version +
                                   "; expected 0.6: download it again, or convert it with osmium");
  pugi::xml_node plain = written.append_child("osm");
  plain.append_attribute("version") = "0.6";
  copy_children(root, "bounds", {"minlat", "minlon", "maxlat", "maxlon"}, plain);
  append_located_refs(root, plain, counts);
  for (const pugi::xml_node object : root.children()) {
    const std::string name = object.name();
    if (name != "node" && name != "way" && name != "relation") continue;
    if (std::string_view(object.attribute("action").value()) == "delete") {
      ++counts["deleted_objects"];
      continue;
    }
    pugi::xml_node copy = plain.append_child(object.name());
    copy_attributes(object, {"id", "lat", "lon", "visible"}, copy);
    copy_children(object, "nd", {"ref"}, copy);
    copy_children(object, "member", {"type", "ref", "role"}, copy);
    copy_children(object, "tag", {"k", "v"}, copy);
  }
  std::ostringstream stream;
  written.save(stream, "", pugi::format_raw);
  return stream.str();
}

std::string node_off_the_earth(const std::string& text) {
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) return "";
  for (const pugi::xml_node node : document.child("osm").children("node"))
    if (!is_place(node) && node.attribute("lat"))
      return std::string("node ") + node.attribute("id").value() + " at latitude " +
             std::string(node.attribute("lat").value()).substr(0, 20) + ", longitude " +
             std::string(node.attribute("lon").value()).substr(0, 20);
  return "";
}

}  // namespace sumogamma::osm
