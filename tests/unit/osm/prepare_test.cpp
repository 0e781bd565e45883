#include "osm/prepare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using testing::ElementsAre;
using testing::Pair;
using testing::SizeIs;

const Tags kStreet = {{"highway", "residential"}};
const Tags kOneWay = {{"highway", "primary"}, {"oneway", "yes"}, {"name", "Ring"}};

/// A street of 200 m with the given tags; its highway value after select_ways(), "" where it was
/// dropped.
std::string kept_as(Tags tags) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 200, 0).way(10, {1, 2}, std::move(tags));
  select_ways(b.map, b.log);
  return b.map.ways.empty() ? "" : tag(b.map.ways[0].tags, "highway");
}

TEST(ReverseTurnLanes, TurnsTheOrderRound) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 200, 0);
  b.way(10, {1, 2}, {{"highway", "primary"}, {"turn:lanes", "left|through;right||"}});
  b.way(11, {1, 2}, {{"highway", "primary"}, {"turn:lanes:backward", "|right"}, {"lanes", "3"}});
  reverse_turn_lanes(b.map, b.log);
  EXPECT_EQ(tag(b.map.ways[0].tags, "turn:lanes"), "||through;right|left");
  EXPECT_EQ(tag(b.map.ways[1].tags, "turn:lanes:backward"), "right|");
  EXPECT_EQ(tag(b.map.ways[1].tags, "lanes"), "3");
}

TEST(SelectWays, KeepsWhatIsOpenAndDropsWhatIsNot) {
  EXPECT_EQ(kept_as({{"highway", "residential"}}), "residential");
  EXPECT_EQ(kept_as({{"highway", "residential"}, {"access", "destination"}}), "residential");
  EXPECT_EQ(kept_as({{"highway", "service"}, {"access", "private"}}), "");
  EXPECT_EQ(kept_as({{"highway", "service"}, {"access", "no"}, {"foot", "yes"}}), "footway");
  EXPECT_EQ(kept_as({{"highway", "service"}, {"access", "no"}, {"bicycle", "yes"}}), "path");
  EXPECT_EQ(kept_as({{"highway", "service"}, {"access", "no"}, {"motor_vehicle", "yes"}}),
            "service");
  EXPECT_EQ(kept_as({{"highway", "residential"}, {"motor_vehicle", "no"}}), "path");
  EXPECT_EQ(kept_as({{"highway", "residential"}, {"motor_vehicle", "no"}, {"bus", "yes"}}),
            "residential");
  EXPECT_EQ(kept_as({{"highway", "residential"}, {"vehicle", "no"}}), "footway");
  EXPECT_EQ(kept_as({{"highway", "residential"}, {"vehicle", "no"}, {"bicycle", "yes"}}), "path");
  EXPECT_EQ(kept_as({{"highway", "residential"}, {"access", "no"}, {"bus", "yes"}}), "residential");
  EXPECT_EQ(kept_as({{"highway", "residential"}, {"access", "no"}, {"motorcycle", "yes"}}),
            "residential");
  EXPECT_EQ(kept_as({{"highway", "footway"}, {"access", "private"}}), "");
  EXPECT_EQ(kept_as({{"highway", "footway"}, {"tunnel", "yes"}, {"layer", "-1"}}), "");
  EXPECT_EQ(kept_as({{"highway", "footway"}, {"tunnel", "building_passage"}}), "footway");
  EXPECT_EQ(kept_as({{"highway", "primary"}, {"tunnel", "yes"}, {"layer", "-1"}}), "primary");
  EXPECT_EQ(kept_as({{"highway", "footway"}, {"indoor", "yes"}}), "");
  EXPECT_EQ(kept_as({{"highway", "proposed"}}), "");
  EXPECT_EQ(kept_as({{"highway", "road"}}), "unclassified");
}

/*      5 (40 m)
        |
    +---2---+       a square with entrances west, north and east
 4--1   .   3--6
    +-------+                                                     */
TEST(SelectWays, ASquareIsCrossedNotRounded) {
  MapBuilder b;
  b.node(1, -20, 0)
      .node(2, 0, 20)
      .node(3, 20, 0)
      .node(7, 0, -20)
      .node(4, -60, 0)
      .node(5, 0, 60)
      .node(6, 60, 0);
  b.way(10, {1, 2, 3, 7, 1}, {{"highway", "pedestrian"}, {"area", "yes"}});
  b.way(11, {4, 1}, {{"highway", "footway"}}).way(12, {5, 2}, {{"highway", "footway"}});
  b.way(13, {3, 6}, {{"highway", "footway"}});
  select_ways(b.map, b.log);
  EXPECT_EQ(b.find_way(10), nullptr);
  EXPECT_THAT(b.map.ways, SizeIs(6));  // three approaches, three spokes
  const std::int64_t center = b.map.ways.back().nodes.back();
  EXPECT_NEAR(b.east(center), 0, 0.1);
  EXPECT_NEAR(b.north(center), 0, 0.1);
  EXPECT_EQ(b.log.count("square_crossed"), 1);
}

/// What becomes of the tags of a road.
Tags normalised(const std::string& highway, Tags tags) {
  tags["highway"] = highway;
  MapBuilder b;
  b.node(1, 0, 0).node(2, 100, 0).way(10, {1, 2}, std::move(tags));
  normalise_tags(b.map, b.log);
  return b.map.ways[0].tags;
}

TEST(NormaliseTags, WritesSidewalksAsNetconvertReadsThem) {
  const std::pair<Tags, std::string> cases[] = {
      {{{"sidewalk", "separate"}}, "no"},
      {{{"sidewalk", "none"}}, "no"},
      {{{"sidewalk:left", "yes"}}, "left"},
      {{{"sidewalk:right", "yes"}, {"sidewalk:left", "no"}}, "right"},
      {{{"sidewalk:both", "yes"}}, "both"},
      {{{"sidewalk:both", "separate"}}, "no"},
      {{{"sidewalk", "both"}}, "both"},
      {{{"tunnel", "yes"}}, "no"},
      {{{"tunnel", "yes"}, {"sidewalk", "both"}}, "both"},
      {{}, ""}};
  for (const auto& [tags, expected] : cases)
    EXPECT_EQ(tag(normalised("residential", tags), "sidewalk"), expected);
}

// somebody on foot met a bus in a tunnel of one lane to each side, and was pressed back through it
// for four minutes, with a dozen behind the bus
TEST(NormaliseTags, NobodyWalksThroughATunnelUnlessTheMapSaysSo) {
  const std::pair<Tags, std::string> cases[] = {{{{"tunnel", "yes"}}, "no"},
                                                {{{"tunnel", "yes"}, {"foot", "yes"}}, "yes"},
                                                {{{"tunnel", "yes"}, {"sidewalk", "both"}}, ""},
                                                {{{"tunnel", "yes"}, {"sidewalk:left", "yes"}}, ""},
                                                {{{"tunnel", "building_passage"}}, ""},
                                                {{}, ""}};
  for (const auto& [tags, expected] : cases)
    EXPECT_EQ(tag(normalised("primary", tags), "foot"), expected);
}

TEST(NormaliseTags, GuessesLanesOfTwoWayMainRoadsOnly) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 100, 0);
  b.way(10, {1, 2}, {{"highway", "primary"}})
      .way(11, {1, 2}, {{"highway", "primary"}, {"oneway", "yes"}});
  b.way(12, {1, 2}, {{"highway", "primary"}, {"lanes", "4"}})
      .way(13, {1, 2}, {{"highway", "tertiary"}});
  b.way(14, {1, 2}, {{"highway", "primary"}, {"junction", "circular"}});
  normalise_tags(b.map, b.log);
  EXPECT_EQ(tag(b.find_way(10)->tags, "lanes"), "2");
  EXPECT_EQ(tag(b.find_way(11)->tags, "lanes"), "");
  EXPECT_EQ(tag(b.find_way(12)->tags, "lanes"), "4");
  EXPECT_EQ(tag(b.find_way(13)->tags, "lanes"), "");
  EXPECT_EQ(tag(b.find_way(14)->tags, "lanes"), "");
  EXPECT_EQ(tag(b.find_way(14)->tags, "junction"), "roundabout");
}

TEST(ClipWays, CutsAtTheEdgeOfTheBox) {
  MapBuilder b;
  b.node(1, -300, 0).node(2, 0, 0).node(3, 300, 0).node(4, 300, 300).node(5, 400, 300);
  b.way(10, {1, 2, 3}, kStreet).way(11, {4, 5}, kStreet);
  clip_ways(b.map, b.box(-100, -100, 100, 100), b.log);
  ASSERT_THAT(b.map.ways, SizeIs(1));
  EXPECT_EQ(b.map.ways[0].id, 10);
  const auto& nodes = b.map.ways[0].nodes;
  ASSERT_THAT(nodes, SizeIs(3));
  EXPECT_NEAR(b.east(nodes.front()), -100, 0.01);
  EXPECT_EQ(nodes[1], 2);
  EXPECT_NEAR(b.east(nodes.back()), 100, 0.01);
  EXPECT_EQ(b.log.count("dropped_outside"), 1);
}

TEST(ClipWays, AWayThatLeavesAndReturnsBecomesTwo) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 300, 0).node(3, 300, 50).node(4, 0, 50);
  b.way(10, {1, 2, 3, 4}, kStreet);
  clip_ways(b.map, b.box(-100, -100, 100, 100), b.log);
  ASSERT_THAT(b.map.ways, SizeIs(2));
  EXPECT_EQ(b.map.ways[0].id, 10);
  EXPECT_GT(b.map.ways[1].id, 10);
  EXPECT_EQ(b.map.ways[1].nodes.back(), 4);
}

TEST(ClipWays, MakesNoNodeWithinAMetreOfAnother) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 99.5, 0).node(3, 300, 0).way(10, {1, 2, 3}, kStreet);
  clip_ways(b.map, b.box(-100, -100, 100, 100), b.log);
  EXPECT_THAT(b.map.ways.at(0).nodes, ElementsAre(1, 2));
}

TEST(SplitCarriagewayEnds, SeparatesAHairpinAtTheRim) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 300, 0).node(3, 0, 12);
  b.way(10, {1, 2}, kOneWay).way(11, {2, 3}, kOneWay);
  split_carriageway_ends(b.map, b.box(-100, -100, 280, 100), b.log);
  EXPECT_NE(b.find_way(10)->nodes.back(), b.find_way(11)->nodes.front());
  EXPECT_EQ(b.log.count("carriageways_separated"), 1);
}

TEST(SplitCarriagewayEnds, LeavesWhatLiesWithinOrGoesStraightOn) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 300, 0).node(3, 0, 12).node(4, 600, 0);
  b.way(10, {1, 2}, kOneWay).way(11, {2, 3}, kOneWay);
  split_carriageway_ends(b.map, b.box(-100, -100, 400, 100), b.log);  // inside
  EXPECT_EQ(b.log.count("carriageways_separated"), 0);
  MapBuilder straight;
  straight.node(1, 0, 0)
      .node(2, 300, 0)
      .node(4, 600, 0)
      .way(10, {1, 2}, kOneWay)
      .way(11, {2, 4}, kOneWay);
  split_carriageway_ends(straight.map, straight.box(-100, -100, 280, 100), straight.log);
  EXPECT_EQ(straight.log.count("carriageways_separated"), 0);
}

/*            5
              |
   2 --s11--> 1 <--s12-- 3      stop lines 30 m out
              |
              4                                       */
MapBuilder crossroads() {
  MapBuilder b;
  b.node(1, 0, 0).node(2, -150, 0).node(3, 150, 0).node(4, 0, -150).node(5, 0, 150);
  b.node(11, -30, 0, {{"highway", "traffic_signals"}})
      .node(12, 30, 0, {{"highway", "traffic_signals"}});
  b.way(101, {2, 11, 1}, kStreet)
      .way(102, {1, 12, 3}, kStreet)
      .way(103, {4, 1}, kStreet)
      .way(104, {1, 5}, kStreet);
  return b;
}

TEST(SnapSignals, MovesStopLinesToTheirJunction) {
  MapBuilder b = crossroads();
  snap_signals(b.map, 60, b.log);
  EXPECT_EQ(tag(b.map.nodes.at(1).tags, "highway"), "traffic_signals");
  EXPECT_EQ(tag(b.map.nodes.at(11).tags, "highway"), "");
  EXPECT_EQ(b.log.count("signal_moved"), 2);
}

TEST(SnapSignals, LeavesWhatIsTooFarOrAPedestrianLight) {
  MapBuilder b = crossroads();
  b.map.nodes.at(12).tags["crossing"] = "traffic_signals";
  snap_signals(b.map, 20, b.log);
  EXPECT_EQ(tag(b.map.nodes.at(11).tags, "highway"), "traffic_signals");
  EXPECT_EQ(tag(b.map.nodes.at(12).tags, "highway"), "traffic_signals");
  EXPECT_EQ(b.log.count("signal_without_junction"), 1);
  EXPECT_EQ(b.log.count("signal_at_crossing"), 1);
}

TEST(SnapSignals, FollowsTheStraightWayPastASlipLane) {
  // 2 --s--> 6 --> 1 (junction); a slip lane leaves at 6
  MapBuilder b;
  b.node(2, -150, 0)
      .node(11, -50, 0, {{"highway", "traffic_signals"}})
      .node(6, -30, 0)
      .node(1, 0, 0);
  b.node(7, -10, -30).node(3, 150, 0).node(4, 0, -150).node(5, 0, 150);
  b.way(101, {2, 11, 6, 1}, kOneWay).way(102, {1, 3}, kOneWay).way(103, {6, 7}, kOneWay);
  b.way(104, {4, 1, 5}, kStreet);
  snap_signals(b.map, 60, b.log);
  EXPECT_EQ(tag(b.map.nodes.at(1).tags, "highway"), "traffic_signals");
}

TEST(SnapSignals, HeedsTheDirectionOfASignal) {
  // between two junctions, 25 m from each: the tag says which one it guards
  for (const auto& [direction, target] : {std::pair("forward", 1), std::pair("backward", 9)}) {
    MapBuilder b;
    b.node(9, -50, 0)
        .node(1, 0, 0)
        .node(3, 150, 0)
        .node(8, -150, 0)
        .node(4, 0, -100)
        .node(7, -50, -100);
    b.node(11, -25, 0, {{"highway", "traffic_signals"}, {"traffic_signals:direction", direction}});
    b.way(101, {9, 11, 1}, kStreet)
        .way(102, {1, 3}, kStreet)
        .way(103, {1, 4}, kStreet)
        .way(104, {8, 9}, kStreet);
    b.way(105, {9, 7}, kStreet);
    snap_signals(b.map, 60, b.log);
    EXPECT_EQ(tag(b.map.nodes.at(target).tags, "highway"), "traffic_signals") << direction;
  }
}

TEST(FindSigns, TellsWhomTheyFaceByJunction) {
  MapBuilder b = crossroads();
  b.map.nodes.at(11).tags = {{"highway", "stop"}};
  b.map.nodes.at(12).tags = {{"highway", "stop"}};
  EXPECT_THAT(find_signs(b.map, "stop", 60),
              ElementsAre(Pair(1, ElementsAre(WayApproach{101, 1}, WayApproach{102, -1}))));
  EXPECT_THAT(find_signs(b.map, "stop", 20), SizeIs(0));
  EXPECT_THAT(find_signs(b.map, "give_way", 60), SizeIs(0));
}

TEST(AddFootwaysAtCrossings, OnlyHalfWayAlongARoad) {
  MapBuilder b = crossroads();
  b.map.nodes.at(11).tags = {{"highway", "crossing"}};
  b.map.nodes.at(12).tags = {{"highway", "crossing"}};
  b.node(12, 8, 0, {{"highway", "crossing"}});  // at the junction: netconvert guesses that one
  add_footways_at_crossings(b.map, b.log);
  ASSERT_THAT(b.map.ways, SizeIs(6));
  EXPECT_EQ(b.map.ways[4].nodes[1], 11);
  EXPECT_NEAR(std::abs(b.north(b.map.ways[4].nodes[0])), 9, 0.1);
  EXPECT_NEAR(b.east(b.map.ways[4].nodes[0]), -30, 0.1);
}

TEST(AddFootwaysAtCrossings, LeavesCrossingsThatHaveAFootway) {
  MapBuilder b = crossroads();
  b.map.nodes.at(11).tags = {{"highway", "crossing"}};
  b.node(21, -30, 40).way(120, {21, 11}, {{"highway", "footway"}});
  add_footways_at_crossings(b.map, b.log);
  EXPECT_THAT(b.map.ways, SizeIs(5));
}

TEST(FilterRestrictions, KeepsOnlyWholeOnes) {
  MapBuilder b = crossroads();
  const auto restriction = [](std::int64_t id, std::int64_t to, std::int64_t via) {
    return MapRelation{id,
                       {{'w', 101, "from"}, {'n', via, "via"}, {'w', to, "to"}},
                       {{"restriction", "no_left_turn"}}};
  };
  b.map.relations = {restriction(1, 104, 1), restriction(2, 999, 1), restriction(3, 104, 2)};
  filter_restrictions(b.map, b.log);
  ASSERT_THAT(b.map.relations, SizeIs(1));
  EXPECT_EQ(b.map.relations[0].id, 1);
}

}  // namespace
}  // namespace sumogamma::osm
