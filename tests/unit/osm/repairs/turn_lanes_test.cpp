#include "osm/repairs/turn_lanes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

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

}  // namespace
}  // namespace sumogamma::osm
