#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/road_scene.h"
#include "support/small_net.h"

namespace sumogamma::testing {

/// Signals: small_net, where link 0 of signal C drives from `in` to `out`.
class SignalTest : public ::testing::Test {
 protected:
  void show(char letter) { here_.road.signal_states[0] = std::string(1, letter) + "r"; }
  RoadScene here_{small_net()};
};

/// Priority: WE is the major road, NS gives way.
class PriorityTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("priority"));
    return network;
  }
  /// The same with stop signs on its minor roads.
  static RoadNetwork net_with_stop_signs() {
    RoadNetwork network = net();
    for (Connection& connection : network.connections)
      if (connection.priority == LinkPriority::Minor) connection.priority = LinkPriority::Stop;
    return network;
  }
  /// A car that stands before the line of its first link.
  std::size_t add_at_line(const std::vector<std::string>& edges, const std::string& lane = "") {
    const std::size_t row = here_.add("car", edges, 0, 0, 0, -1, lane);
    here_.move(row, here_.path(row).links.front().stop_line - 2.25 - 0.6);
    return row;
  }
  /// Where the ways of two cars over their first links are in each other's.
  ConflictZone conflict_of(std::size_t row, std::size_t other) const {
    const PathLink& link = here_.path(row).links.front();
    const ConnectionId foe = here_.path(other).links.front().connection;
    for (const ConflictZone& zone : here_.model.conflicts[index_of(link.connection)])
      if (zone.foe == foe && zone.of_narrow) return *zone_for(zone, false);
    ADD_FAILURE() << "their ways don't cross";
    return {};
  }
  /// Where the way of `row` begins to be in that of `other` [m along its path].
  double zone_of(std::size_t row, std::size_t other) const {
    return here_.path(row).links.front().stop_line + conflict_of(row, other).begin;
  }
  RoadScene here_{net()};
};

/// Crossings: drivers yield on the crossroads with sidewalks.
class CrossingTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = [] {
      PlainNet plain = crossroads("priority", {"--sidewalks.guess", "--crossings.guess"});
      return read_plain_net(plain);
    }();
    return network;
  }
  /// Makes a crossing one on which people go first.
  void give_priority(ConnectionId crossing) {
    for (auto& zones : here_.model.conflicts)
      for (ConflictZone& zone : zones)
        if (zone.foe == crossing) zone.yields = true;
    for (ConflictZone& zone : here_.model.conflicts[index_of(crossing)]) zone.yields = false;
  }
  RoadScene here_{net()};
};

}  // namespace sumogamma::testing
