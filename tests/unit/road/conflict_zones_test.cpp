#include "road/conflict_zones.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/plain_net.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::PlainNet;
using testing::read_plain_net;

ConnectionId link_between(const RoadNetwork& network, const std::string& from,
                          const std::string& to) {
  const LaneId a = network.lane_by_name.at(from), b = network.lane_by_name.at(to);
  for (std::size_t i = 0; i < network.connections.size(); ++i)
    if (network.connections[i].from == a && network.connections[i].to == b)
      return static_cast<ConnectionId>(i);
  throw std::runtime_error("no link from " + from + " to " + to);
}

const ConflictZone* zone_between(const ConflictTable& table, ConnectionId own, ConnectionId foe) {
  for (const ConflictZone& zone : table[index_of(own)])
    if (zone.foe == foe) return &zone;
  return nullptr;
}

/// Arms, each with a lane to and from C, which is among the nodes; `lane`: attributes of all edges.
PlainNet one_lane_each_way(const std::string& nodes, const std::string& arms,
                           const std::string& lane) {
  PlainNet plain;
  plain.nodes = nodes;
  for (const char arm : arms)
    for (const std::string& ends : {std::string{arm, 'C'}, std::string{'C', arm}})
      plain.edges += "<edge id=\"" + ends + "\" from=\"" + ends[0] + "\" to=\"" + ends[1] +
                     "\" numLanes=\"1\" " + lane + "/>";
  return plain;
}

class Conflicts : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("priority"));
    return network;
  }
  static const ConflictTable& table() {
    static const ConflictTable conflicts = build_conflict_table(net());
    return conflicts;
  }
};

TEST_F(Conflicts, CrossingWaysMeetWhereTheyCross) {
  const ConnectionId through = link_between(net(), "WC_0", "CE_0");
  const ConnectionId minor = link_between(net(), "SC_0", "CN_0");
  const ConflictZone* own = zone_between(table(), minor, through);
  const ConflictZone* foe = zone_between(table(), through, minor);
  ASSERT_TRUE(own && foe);
  EXPECT_TRUE(own->yields);
  EXPECT_FALSE(foe->yields);
  EXPECT_FALSE(own->unruled);
  // both tell the same place
  EXPECT_NEAR(own->begin, foe->foe_begin, 1e-9);
  EXPECT_NEAR(own->end, foe->foe_end, 1e-9);
  const Polyline a = link_geometry(net(), minor), b = link_geometry(net(), through);
  const Vec2 middle_a = a.point_at(0.5 * (own->begin + own->end));
  const Vec2 middle_b = b.point_at(0.5 * (own->foe_begin + own->foe_end));
  EXPECT_LT((middle_a - middle_b).norm(), 1.0);
  // two bodies of at most 2.7 m, sampled every metre
  EXPECT_LT(own->end - own->begin, 6.0);
  EXPECT_GE(own->end - own->begin, 2.0);
}

TEST_F(Conflicts, NarrowBodiesShareLessOfTheirWays) {
  const ConflictZone* zone = zone_between(table(), link_between(net(), "SC_0", "CN_0"),
                                          link_between(net(), "WC_0", "CE_0"));
  ASSERT_NE(zone, nullptr);
  const auto wide = zone_for(*zone, true), narrow = zone_for(*zone, false);
  ASSERT_TRUE(wide && narrow);
  EXPECT_EQ(wide->begin, zone->begin);
  EXPECT_LT(narrow->end - narrow->begin, wide->end - wide->begin);
  EXPECT_LT(narrow->foe_end - narrow->foe_begin, wide->foe_end - wide->foe_begin);
  EXPECT_GE(narrow->begin, wide->begin);
  EXPECT_GE(narrow->foe_begin, wide->foe_begin);
  EXPECT_EQ(narrow->foe, wide->foe);
  EXPECT_EQ(narrow->yields, wide->yields);
}

TEST_F(Conflicts, MergingWaysMeetUntilTheirEnd) {
  const ConnectionId through = link_between(net(), "WC_0", "CE_0");
  const ConnectionId right_turn = link_between(net(), "SC_0", "CE_0");
  const ConflictZone* zone = zone_between(table(), right_turn, through);
  ASSERT_NE(zone, nullptr);
  EXPECT_TRUE(zone->yields);
  const double length = link_geometry(net(), right_turn).length();
  EXPECT_GT(zone->end, length - 2.5);
  EXPECT_GT(zone->begin, 0.0);
}

TEST_F(Conflicts, ALeftTurnYieldsToOncomingTraffic) {
  const ConnectionId turn = link_between(net(), "WC_1", "CN_0");
  const ConnectionId oncoming = link_between(net(), "EC_0", "CW_0");
  const ConflictZone* zone = zone_between(table(), turn, oncoming);
  ASSERT_NE(zone, nullptr);
  EXPECT_TRUE(zone->yields);
}

TEST_F(Conflicts, WaysThatNeverMeetAreLeftOut) {
  const ConnectionId right_turn = link_between(net(), "WC_0", "CS_0");
  const ConnectionId opposite = link_between(net(), "EC_0", "CW_0");
  EXPECT_EQ(zone_between(table(), right_turn, opposite), nullptr);
}

TEST_F(Conflicts, WaysFromOneEdgeAreNoConflict) {
  const ConnectionId straight = link_between(net(), "SC_0", "CN_0");
  const ConnectionId turn = link_between(net(), "SC_0", "CE_0");
  EXPECT_EQ(zone_between(table(), straight, turn), nullptr);
}

TEST_F(Conflicts, ZonesLieOnTheirLinksAndComeInPairs) {
  for (std::size_t i = 0; i < table().size(); ++i)
    for (const ConflictZone& zone : table()[i]) {
      EXPECT_LE(zone.begin, zone.end);
      EXPECT_GE(zone.begin, 0.0);
      EXPECT_LE(zone.end, link_geometry(net(), static_cast<ConnectionId>(i)).length() + 1.0);
      const ConflictZone* other = zone_between(table(), zone.foe, static_cast<ConnectionId>(i));
      ASSERT_NE(other, nullptr) << "link " << i << " knows a foe that doesn't know it";
      EXPECT_EQ(zone.unruled, other->unruled);
      EXPECT_FALSE(zone.yields && zone.unruled);
    }
}

TEST(ConflictZones, OppositeTurnsOnANarrowJunctionConflictThoughTheMatrixSaysNo) {
  // arms that are 6 m off: left turns from both sides sweep the same ground
  const std::string nodes = R"(<node id="C" x="0" y="0" type="priority"/>
    <node id="W" x="-100" y="0"/><node id="E" x="100" y="0"/><node id="N" x="0" y="100"/>
    <node id="S" x="0" y="-100"/>)";
  const RoadNetwork network = read_plain_net(one_lane_each_way(nodes, "WENS", R"(speed="13.9")"));
  const ConflictTable conflicts = build_conflict_table(network);
  const ConnectionId a = link_between(network, "WC_0", "CN_0");
  const ConnectionId b = link_between(network, "EC_0", "CS_0");
  const Junction& junction = network.junction(network.connection(a).junction);
  const auto row = static_cast<std::size_t>(network.connection(a).junction_link);
  const auto column = static_cast<std::size_t>(network.connection(b).junction_link);
  const bool ruled = junction.requests[row].conflicts[column];
  const ConflictZone* zone = zone_between(conflicts, a, b);
  ASSERT_NE(zone, nullptr) << "bodies of cars meet here";
  EXPECT_EQ(zone->unruled, !ruled);
}

// cars entered a ring a tenth of a second earlier each, and more of them than the band of
// roundabout_entry allows
TEST(ConflictZones, WhoEntersARoundaboutWaitsForAnybodysGap) {
  RoadNetwork network = read_plain_net(crossroads("priority"));
  for (const bool ring : {false, true}) {
    for (Junction& junction : network.junctions) junction.in_roundabout = ring;
    const ConflictTable conflicts = build_conflict_table(network);
    const ConnectionId through = link_between(network, "WC_0", "CE_0");
    const ConflictZone* joins =
        zone_between(conflicts, link_between(network, "SC_0", "CE_0"), through);
    const ConflictZone* crosses =
        zone_between(conflicts, link_between(network, "SC_0", "CN_0"), through);
    ASSERT_TRUE(joins && crosses && joins->of_narrow && crosses->of_narrow);
    EXPECT_EQ(joins->of_narrow->begin == joins->begin, ring);
    EXPECT_EQ(joins->of_narrow->foe_begin == joins->foe_begin, ring);
    EXPECT_LT(crosses->of_narrow->end - crosses->of_narrow->begin, crosses->end - crosses->begin);
  }
}

TEST(ConflictZones, WhereBusesMeetCarsMayPassEachOther) {
  const std::string nodes = R"(<node id="C" x="0" y="0" type="priority"/>
    <node id="W" x="-100" y="0"/><node id="E" x="100" y="0"/><node id="N" x="0" y="100"/>
    <node id="S" x="0" y="-100"/>)";
  PlainNet plain = one_lane_each_way(nodes, "WENS", R"(speed="13.9")");
  plain.options = {"--default.junctions.radius", "5"};
  const RoadNetwork network = read_plain_net(plain);
  const ConflictTable conflicts = build_conflict_table(network);
  const ConflictZone* zone = zone_between(conflicts, link_between(network, "WC_0", "CN_0"),
                                          link_between(network, "EC_0", "CS_0"));
  ASSERT_NE(zone, nullptr);
  EXPECT_TRUE(zone_for(*zone, true));
  EXPECT_FALSE(zone_for(*zone, false));
}

// with lanes of 2.8 m the oncoming way counted as met from the stop line on: nobody waited on the
// junction, and none got over it at the end of its green
TEST(ConflictZones, WhoTurnsAcrossThoseWhoComeTowardsItHasRoomToWaitOnTheJunction) {
  const std::string nodes = R"(<node id="C" x="0" y="0" type="traffic_light"/>
    <node id="W" x="-100" y="0"/><node id="E" x="100" y="0"/><node id="N" x="0" y="100"/>)";
  PlainNet plain = one_lane_each_way(nodes, "WEN", R"(width="2.8" speed="13.9")");
  plain.options = {"--default.junctions.radius", "6"};
  const RoadNetwork network = read_plain_net(plain);
  const ConflictTable conflicts = build_conflict_table(network);
  const ConnectionId turn = link_between(network, "WC_0", "CN_0");
  const ConnectionId oncoming = link_between(network, "EC_0", "CW_0");
  const ConflictZone* zone = zone_between(conflicts, turn, oncoming);
  ASSERT_NE(zone, nullptr);
  EXPECT_TRUE(zone->yields);
  EXPECT_GT(zone->begin, 2.0);
  const ConflictZone* other = zone_between(conflicts, oncoming, turn);
  ASSERT_NE(other, nullptr);
  EXPECT_NEAR(other->end, zone->foe_end, 1e-9);
}

// who met somebody on a junction of narrow roads or cycleways took turns with whoever came towards
// it, side by side though their lanes were
TEST(ConflictZones, TheTwoDirectionsOfANarrowRoadAreNotInEachOthersWay) {
  const std::string nodes = R"(<node id="C" x="0" y="0"/><node id="W" x="-80" y="0"/>
    <node id="E" x="70" y="30"/><node id="S" x="0" y="-80"/>)";
  for (const char* lane :
       {R"(width="2.75" speed="5.6")", R"(width="1.0" speed="5.6" allow="bicycle pedestrian")"}) {
    const RoadNetwork network = read_plain_net(one_lane_each_way(nodes, "WES", lane));
    const ConflictTable conflicts = build_conflict_table(network);
    EXPECT_EQ(zone_between(conflicts, link_between(network, "WC_0", "CE_0"),
                           link_between(network, "EC_0", "CW_0")),
              nullptr)
        << lane;
    EXPECT_NE(zone_between(conflicts, link_between(network, "WC_0", "CE_0"),
                           link_between(network, "SC_0", "CW_0")),
              nullptr)
        << lane << ": their ways do cross";
  }
}

// rounded as for a car the turn of a cycleway missed those whom bicycles meet on it
TEST(ConflictZones, CyclewaysMeetWhereBicyclesTurn) {
  const std::string nodes = R"(<node id="C" x="0" y="0"/><node id="E" x="48" y="13"/>
    <node id="N" x="10" y="50"/><node id="S" x="-14" y="-50"/>)";
  PlainNet plain =
      one_lane_each_way(nodes, "ENS", R"(width="1.0" speed="5.6" allow="bicycle pedestrian")");
  plain.options = {"--lefthand", "--default.junctions.radius", "1.5"};
  const RoadNetwork network = read_plain_net(plain);
  const ConnectionId turn = link_between(network, "NC_0", "CE_0");
  const ConflictTable conflicts = build_conflict_table(network);
  const ConflictZone* zone = zone_between(conflicts, turn, link_between(network, "SC_0", "CE_0"));
  ASSERT_NE(zone, nullptr);
  EXPECT_GT(zone->end, link_geometry(network, turn).length() - 0.7);
}

TEST(ConflictZones, DriversYieldOnACrossingOverItsWholeWidth) {
  const RoadNetwork network = testing::small_net();
  const ConflictTable conflicts = build_conflict_table(network);
  const ConnectionId drive = link_between(network, "in_1", "out_0");
  const ConnectionId back = link_between(network, "back_in_0", "back_0");
  const ConnectionId walk = link_between(network, ":C_w0_0", ":C_c0_0");
  // small_net: the row of link 0 names link 2 as foe, the crossing gives way to both
  const ConflictZone* zone = zone_between(conflicts, drive, walk);
  ASSERT_NE(zone, nullptr);
  EXPECT_TRUE(zone->foe_is_crossing);
  EXPECT_FALSE(zone->yields);
  // crossing at x = 101, 4 m wide; the junction begins at x = 95
  EXPECT_NEAR(0.5 * (zone->begin + zone->end), 6.0, 1.0);
  EXPECT_GE(zone->end - zone->begin, 4.0);
  const ConflictZone* own = zone_between(conflicts, walk, drive);
  ASSERT_NE(own, nullptr);
  EXPECT_TRUE(own->yields);
  // the crossing starts at y = -5: the lane at y = 0 is its far one, that at y = -3.2 the near one
  const ConflictZone* near_one = zone_between(conflicts, walk, back);
  ASSERT_NE(near_one, nullptr);
  EXPECT_LT(near_one->begin, own->begin);
  EXPECT_NEAR(own->foe_begin, zone->begin, 1e-9);
}

TEST(LinkGeometry, ALinkWithoutInsideIsEmpty) {
  const RoadNetwork network = testing::small_net();
  const Polyline inside = link_geometry(network, link_between(network, "in_1", "out_0"));
  EXPECT_NEAR(inside.length(), 10.0, 1e-9);
  RoadNetwork bare = network;
  bare.connections[index_of(link_between(network, "in_1", "out_0"))].via = kNoLane;
  EXPECT_TRUE(link_geometry(bare, link_between(network, "in_1", "out_0")).empty());
  EXPECT_NO_THROW(build_conflict_table(bare));
}

}  // namespace
}  // namespace sumogamma
