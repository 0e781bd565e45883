#include "osm/repairs/turn_lanes.h"

#include <string>

#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

/// "a||c" for "c||a".
std::string reversed_list(const std::string& list) {
  std::string reversed;
  for (std::size_t end = list.size();;) {
    const std::size_t bar = end == 0 ? std::string::npos : list.rfind('|', end - 1);
    const std::size_t begin = bar == std::string::npos ? 0 : bar + 1;
    reversed += list.substr(begin, end - begin);
    if (begin == 0) return reversed;
    reversed += '|';
    end = bar;
  }
}

}  // namespace

void reverse_turn_lanes(OsmMap& map, IssueLog& log) {
  for (MapWay& way : map.ways)
    for (const char* key : {"turn:lanes", "turn:lanes:forward", "turn:lanes:backward"}) {
      const auto found = way.tags.find(key);
      if (found == way.tags.end()) continue;
      found->second = reversed_list(found->second);
      log.add(Severity::Note, "turn_lanes_reversed",
              "turn lanes that netconvert 1.15 reads in the wrong order where traffic keeps left",
              way_name(way));
    }
}
}  // namespace sumogamma::osm
