#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "support/road_scene.h"

namespace sumogamma::testing {

/// Lets all links of a lane show a letter.
inline void show(RoadScene& here, LaneId from, char letter) {
  const RoadNetwork& road = here.model.road;
  for (const ConnectionId id : road.lane(from).outgoing) {
    const Connection& link = road.connection(id);
    if (link.signal == kNoSignal) continue;
    std::string& letters = here.road.signal_states[index_of(link.signal)];
    letters.resize(std::max(letters.size(), static_cast<std::size_t>(link.signal_link) + 1), 'r');
    letters[static_cast<std::size_t>(link.signal_link)] = letter;
  }
}
inline void show(RoadScene& here, const char* lane, char letter) {
  show(here, here.model.road.lane_by_name.at(lane), letter);
}

/// On crossroads with a light: green for all who come from west and east, a letter for the others.
inline void show_across_green(RoadScene& here, char letter) {
  for (const char* edge : {"WC", "EC", "SC", "NC"})
    for (const LaneId lane : here.model.road.edge(here.model.road.edge_by_name.at(edge)).lanes)
      show(here, lane, edge[0] == 'W' || edge[0] == 'E' ? 'G' : letter);
}

}  // namespace sumogamma::testing
