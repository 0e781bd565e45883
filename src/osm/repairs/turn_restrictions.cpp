#include "osm/repairs/turn_restrictions.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace sumogamma::osm {

void drop_broken_restrictions(OsmMap& map, IssueLog& log) {
  std::map<std::int64_t, const MapWay*> ways;
  for (const MapWay& way : map.ways)
    if (way.tags.contains("highway")) ways[way.id] = &way;
  std::vector<MapRelation> kept;
  for (MapRelation& relation : map.relations) {
    int from = 0, to = 0, via = 0;
    bool whole = true;
    std::int64_t via_node = 0;
    for (const MapMember& member : relation.members) {
      from += member.role == "from";
      to += member.role == "to";
      via += member.role == "via";
      if (member.type == 'w') whole = whole && ways.contains(member.ref);
      if (member.type == 'n') via_node = member.ref;
    }
    for (const MapMember& member : relation.members)
      if (whole && via_node != 0 && member.type == 'w')
        whole = ways.at(member.ref)->nodes.front() == via_node ||
                ways.at(member.ref)->nodes.back() == via_node;
    if (whole && from == 1 && to == 1 && via == 1)
      kept.push_back(std::move(relation));
    else
      log.add(Severity::Note, "dropped_restriction",
              "turn restrictions with a member outside the map",
              "relation/" + std::to_string(relation.id));
  }
  map.relations = std::move(kept);
}
}  // namespace sumogamma::osm
