#include "osm/network_file.h"

#include <cstdlib>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "road/sumo_net_reader.h"

namespace sumogamma::osm {

NetworkFile load_network(const std::filesystem::path& file) {
  NetworkFile network;
  if (!network.document.load_file(file.c_str())) throw Error(file.string(), "not a network");
  network.road = read_net_elements(network.document, file);
  return network;
}

std::map<std::string, std::set<std::int64_t>> ways_of_edges(const pugi::xml_node& net) {
  std::map<std::string, std::set<std::int64_t>> ways;
  for (const pugi::xml_node edge : net.children("edge")) {
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

void save_xml(const pugi::xml_document& document, const std::filesystem::path& file) {
  if (!document.save_file(file.c_str(), "    "))
    throw Error(file.string(), "cannot be written: is the disk full?");
}

std::vector<Vec2> shape_of(const pugi::xml_node& element) {
  std::vector<Vec2> points;
  for (const char* at = element.attribute("shape").value(); *at != '\0';) {
    char* end = nullptr;
    const double x = std::strtod(at, &end);
    if (end == at || *end != ',') break;
    const char* second = end + 1;
    points.emplace_back(x, std::strtod(second, &end));
    // a height may follow
    while (*end != '\0' && *end != ' ') ++end;
    at = *end == ' ' ? end + 1 : end;
  }
  return points;
}

}  // namespace sumogamma::osm
