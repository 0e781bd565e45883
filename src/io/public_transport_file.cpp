#include "io/public_transport_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <utility>

#include "base/error.h"

namespace sumogamma {
namespace {

constexpr std::string_view kRoutePrefix = "line.";

std::string metres(double value) { return fmt::format("{:.2f}", value); }

void set(pugi::xml_node node, const char* key, const std::string& value) {
  node.append_attribute(key) = value.c_str();
}

void append_parameter(pugi::xml_node node, const char* key, const std::string& value) {
  pugi::xml_node parameter = node.append_child("param");
  set(parameter, "key", key);
  set(parameter, "value", value);
}

std::string parameter(const pugi::xml_node& node, const char* key) {
  return node.find_child_by_attribute("param", "key", key).attribute("value").value();
}

LaneId lane_of(const std::string& file, const RoadNetwork& road, const pugi::xml_node& node) {
  const auto lane = road.lane_by_name.find(node.attribute("lane").value());
  if (lane != road.lane_by_name.end()) return lane->second;
  throw Error(file, std::string("<") + node.name() + " id=\"" + node.attribute("id").value() +
                        "\">: the network has no lane '" + node.attribute("lane").value() + "'");
}

BusStop read_stop(const std::string& file, const RoadNetwork& road, const pugi::xml_node& node) {
  BusStop stop;
  stop.id = node.attribute("id").value();
  stop.name = node.attribute("name").value();
  stop.lane = lane_of(file, road, node);
  stop.begin = node.attribute("startPos").as_double(0.0);
  stop.end = node.attribute("endPos").as_double(road.lane(stop.lane).length);
  if (const pugi::xml_node access = node.child("access"))
    stop.access = StopAccess{lane_of(file, road, access), access.attribute("pos").as_double(0.0)};
  return stop;
}

LinePart read_part(const std::string& file, const RoadNetwork& road,
                   const std::map<std::string, std::size_t>& stops, const PublicTransport& known,
                   const pugi::xml_node& node) {
  LinePart part;
  const std::string id = node.attribute("id").value();
  part.id = id.substr(id.starts_with(kRoutePrefix) ? kRoutePrefix.size() : 0);
  part.line = parameter(node, "line");
  part.kind = parameter(node, "kind");
  part.headway = std::max(
      0.0,
      node.find_child_by_attribute("param", "key", "headway").attribute("value").as_double(0.0));
  if (part.line.empty()) part.line = part.id;
  std::istringstream edges(node.attribute("edges").value());
  for (std::string edge; edges >> edge;) {
    const auto found = road.edge_by_name.find(edge);
    if (found == road.edge_by_name.end())
      throw Error(file, "<route id=\"" + id + "\">: the network has no edge '" + edge + "'");
    part.route.push_back(found->second);
  }
  std::size_t at = 0;
  for (const pugi::xml_node halt : node.children("stop")) {
    const auto found = stops.find(halt.attribute("busStop").value());
    if (found == stops.end())
      throw Error(file, "<route id=\"" + id + "\">: there is no <busStop> '" +
                            halt.attribute("busStop").value() + "' before it");
    const EdgeId edge = road.lane(known.stops[found->second].lane).edge;
    const auto begin = part.route.begin() + static_cast<std::ptrdiff_t>(at);
    const auto on = std::find(begin, part.route.end(), edge);
    if (on == part.route.end())
      throw Error(file, "<route id=\"" + id + "\">: its stop '" + found->first +
                            "' doesn't lie on it, in that order");
    at = static_cast<std::size_t>(on - part.route.begin());
    part.stops.push_back({found->second, at});
  }
  return part;
}

}  // namespace

void write_public_transport(const std::filesystem::path& file, const RoadNetwork& road,
                            const PublicTransport& transport) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("additional");
  for (const BusStop& stop : transport.stops) {
    pugi::xml_node node = root.append_child("busStop");
    set(node, "id", stop.id);
    if (!stop.name.empty()) set(node, "name", stop.name);
    set(node, "lane", road.lane(stop.lane).name);
    set(node, "startPos", metres(stop.begin));
    set(node, "endPos", metres(stop.end));
    if (!stop.access) continue;
    pugi::xml_node access = node.append_child("access");
    set(access, "lane", road.lane(stop.access->lane).name);
    set(access, "pos", metres(stop.access->along));
  }
  for (const LinePart& part : transport.parts) {
    pugi::xml_node node = root.append_child("route");
    set(node, "id", std::string(kRoutePrefix) + part.id);
    std::string edges;
    for (const EdgeId edge : part.route) edges += (edges.empty() ? "" : " ") + road.edge(edge).name;
    set(node, "edges", edges);
    for (const ServedStop& served : part.stops) {
      pugi::xml_node halt = node.append_child("stop");
      set(halt, "busStop", transport.stops[served.stop].id);
      set(halt, "duration", metres(kDwell));
    }
    append_parameter(node, "line", part.line);
    append_parameter(node, "kind", part.kind);
    if (part.headway > 0) append_parameter(node, "headway", metres(part.headway));
  }
  if (!document.save_file(file.c_str(), "  "))
    throw Error(file.string(), "cannot be written: is the disk full?");
}

PublicTransport read_public_transport(const std::filesystem::path& file, const RoadNetwork& road) {
  pugi::xml_document document;
  if (!document.load_file(file.c_str())) throw Error(file.string(), "is no readable XML");
  PublicTransport transport;
  std::map<std::string, std::size_t> stops;
  for (const pugi::xml_node node : document.document_element().children("busStop")) {
    stops[node.attribute("id").value()] = transport.stops.size();
    transport.stops.push_back(read_stop(file.string(), road, node));
  }
  for (const pugi::xml_node node : document.document_element().children("route"))
    transport.parts.push_back(read_part(file.string(), road, stops, transport, node));
  return transport;
}

}  // namespace sumogamma
