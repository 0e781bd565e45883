#include "road/swept_ways.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;

RoadNetwork narrow_corners(const std::string& disallowed = {}) {
  std::vector<std::string> options = {"--default.junctions.radius", "3"};
  if (!disallowed.empty()) options.insert(options.end(), {"--default.disallow", disallowed});
  return read_plain_net(crossroads("priority", options));
}

TEST(SweptWays, ABusThatTurnsSweepsTheEndsOfLanesOnWhichOthersWait) {
  const RoadNetwork network = narrow_corners();
  const SweptWayTable table = find_swept_ways(network, build_conflict_table(network));
  int ends = 0;
  for (std::size_t i = 0; i < table.size(); ++i)
    for (const SweptWay& way : table[i]) {
      if (way.foe_sweeps) {
        EXPECT_LE(way.begin, way.end);
      }
      EXPECT_NE(network.lane(network.connections[i].from).edge,
                network.lane(network.connection(way.foe).from).edge);
      // the other link knows the same
      const auto& theirs = table[index_of(way.foe)];
      EXPECT_TRUE(std::any_of(theirs.begin(), theirs.end(), [&](const SweptWay& other) {
        return other.foe == static_cast<ConnectionId>(i) && other.foe_sweeps != way.foe_sweeps &&
               other.begin == way.foe_begin && other.foe_end == way.end;
      }));
      if (!way.foe_sweeps) continue;
      EXPECT_GE(way.begin, -20.0) << "nobody halts farther back";
      ends += way.begin < 0.0;
    }
  EXPECT_GT(ends, 0);
}

TEST(SweptWays, WideBodiesNeedMoreRoomThanCars) {
  const RoadNetwork network = narrow_corners();
  int more = 0;
  for (const auto& ways : find_swept_ways(network, build_conflict_table(network)))
    for (const SweptWay& car : ways) {
      if (car.for_wide || !car.foe_sweeps) continue;
      const auto wide = std::find_if(ways.begin(), ways.end(), [&](const SweptWay& other) {
        return other.for_wide && other.foe_sweeps && other.foe == car.foe && other.body == car.body;
      });
      if (wide == ways.end()) continue;  // so far back that nobody halts for it
      EXPECT_LE(wide->begin, car.begin);
      EXPECT_GE(wide->end, car.end);
      more += wide->begin < car.begin;
    }
  EXPECT_GT(more, 0);
}

TEST(SweptWays, ATruckSweepsLessThanABus) {
  const RoadNetwork network = narrow_corners();
  int less = 0;
  for (const auto& ways : find_swept_ways(network, build_conflict_table(network)))
    for (const SweptWay& truck : ways) {
      if (truck.body != TurningBody::Truck || !truck.foe_sweeps) continue;
      const auto bus = std::find_if(ways.begin(), ways.end(), [&](const SweptWay& other) {
        return other.body == TurningBody::Bus && other.foe_sweeps && other.foe == truck.foe &&
               other.for_wide == truck.for_wide;
      });
      if (bus == ways.end()) continue;  // so far back that nobody halts for it
      EXPECT_GE(truck.begin, bus->begin);
      less += truck.begin > bus->begin;
    }
  EXPECT_GT(less, 0);
}

// side by side on lanes of 2.75 m a bus leaves others 0.25 m: it sweeps their lane only as long as
// it is askew, or everything behind its turn would count as swept
TEST(SweptWays, OnNarrowLanesEndWhereTheBusIsStraightAgain) {
  const RoadNetwork network = read_plain_net(
      crossroads("priority", {"--default.junctions.radius", "3", "--default.lanewidth", "2.75"}));
  const SweptWayTable table = find_swept_ways(network, build_conflict_table(network));
  int halts = 0;
  for (const auto& ways : table)
    for (const SweptWay& way : ways) halts += way.foe_sweeps && way.for_wide && way.begin < -5.0;
  EXPECT_GT(halts, 0) << "a bus that waits leaves a turning bus room";
}

TEST(SweptWays, WhereABodyMayNotDriveItSweepsNothing) {
  const RoadNetwork no_buses = narrow_corners("bus");
  for (const auto& ways : find_swept_ways(no_buses, build_conflict_table(no_buses)))
    for (const SweptWay& way : ways) EXPECT_EQ(way.body, TurningBody::Truck);
  const RoadNetwork neither = narrow_corners("bus truck");
  for (const auto& ways : find_swept_ways(neither, build_conflict_table(neither)))
    EXPECT_TRUE(ways.empty());
}

TEST(SweptWays, StraightOnSweepsNothing) {
  const RoadNetwork network = narrow_corners();
  const SweptWayTable table = find_swept_ways(network, build_conflict_table(network));
  for (std::size_t i = 0; i < table.size(); ++i)
    for (const SweptWay& way : table[i])
      EXPECT_FALSE(!way.foe_sweeps && network.connections[i].direction == TurnDirection::Straight);
}

}  // namespace
}  // namespace sumogamma
