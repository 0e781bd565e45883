#include "osm/repairs/stop_line_signals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"
#include "support/osm/street_tags.h"

namespace sumogamma::osm {
namespace {

const Tags kOneWay = {{"highway", "primary"}, {"oneway", "yes"}, {"name", "Ring"}};

TEST(StopLineSignals, MovesStopLinesToTheirJunction) {
  MapBuilder b = crossroads_with_stop_lines();
  move_signals_to_junctions(b.map, 60, b.log);
  EXPECT_EQ(tag(b.map.nodes.at(1).tags, "highway"), "traffic_signals");
  EXPECT_EQ(tag(b.map.nodes.at(11).tags, "highway"), "");
  EXPECT_EQ(b.log.count("signal_moved"), 2);
}

TEST(StopLineSignals, LeavesWhatIsTooFarOrAPedestrianLight) {
  MapBuilder b = crossroads_with_stop_lines();
  b.map.nodes.at(12).tags["crossing"] = "traffic_signals";
  move_signals_to_junctions(b.map, 20, b.log);
  EXPECT_EQ(tag(b.map.nodes.at(11).tags, "highway"), "traffic_signals");
  EXPECT_EQ(tag(b.map.nodes.at(12).tags, "highway"), "traffic_signals");
  EXPECT_EQ(b.log.count("signal_without_junction"), 1);
  EXPECT_EQ(b.log.count("signal_at_crossing"), 1);
}

TEST(StopLineSignals, FollowsTheStraightWayPastASlipLane) {
  // 2 --s--> 6 --> 1 (junction); a slip lane leaves at 6
  MapBuilder b;
  b.node(2, -150, 0)
      .node(11, -50, 0, {{"highway", "traffic_signals"}})
      .node(6, -30, 0)
      .node(1, 0, 0);
  b.node(7, -10, -30).node(3, 150, 0).node(4, 0, -150).node(5, 0, 150);
  b.way(101, {2, 11, 6, 1}, kOneWay).way(102, {1, 3}, kOneWay).way(103, {6, 7}, kOneWay);
  b.way(104, {4, 1, 5}, kStreet);
  move_signals_to_junctions(b.map, 60, b.log);
  EXPECT_EQ(tag(b.map.nodes.at(1).tags, "highway"), "traffic_signals");
}

TEST(StopLineSignals, HeedsTheDirectionOfASignal) {
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
    move_signals_to_junctions(b.map, 60, b.log);
    EXPECT_EQ(tag(b.map.nodes.at(target).tags, "highway"), "traffic_signals") << direction;
  }
}

}  // namespace
}  // namespace sumogamma::osm
