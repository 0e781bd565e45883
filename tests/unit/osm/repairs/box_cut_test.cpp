#include "osm/repairs/box_cut.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"
#include "support/osm/street_tags.h"

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

TEST(CutAtBox, CutsAtTheEdgeOfTheBox) {
  MapBuilder b;
  b.node(1, -300, 0).node(2, 0, 0).node(3, 300, 0).node(4, 300, 300).node(5, 400, 300);
  b.way(10, {1, 2, 3}, kStreet).way(11, {4, 5}, kStreet);
  cut_at_box(b.map, b.box(-100, -100, 100, 100), b.log);
  ASSERT_THAT(b.map.ways, SizeIs(1));
  EXPECT_EQ(b.map.ways[0].id, 10);
  const auto& nodes = b.map.ways[0].nodes;
  ASSERT_THAT(nodes, SizeIs(3));
  EXPECT_NEAR(b.east(nodes.front()), -100, 0.01);
  EXPECT_EQ(nodes[1], 2);
  EXPECT_NEAR(b.east(nodes.back()), 100, 0.01);
  EXPECT_EQ(b.log.count("dropped_outside"), 1);
}

TEST(CutAtBox, AWayThatLeavesAndReturnsBecomesTwo) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 300, 0).node(3, 300, 50).node(4, 0, 50);
  b.way(10, {1, 2, 3, 4}, kStreet);
  cut_at_box(b.map, b.box(-100, -100, 100, 100), b.log);
  ASSERT_THAT(b.map.ways, SizeIs(2));
  EXPECT_EQ(b.map.ways[0].id, 10);
  EXPECT_GT(b.map.ways[1].id, 10);
  EXPECT_EQ(b.map.ways[1].nodes.back(), 4);
}

TEST(CutAtBox, MakesNoNodeWithinAMetreOfAnother) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 99.5, 0).node(3, 300, 0).way(10, {1, 2, 3}, kStreet);
  cut_at_box(b.map, b.box(-100, -100, 100, 100), b.log);
  EXPECT_THAT(b.map.ways.at(0).nodes, ElementsAre(1, 2));
}

}  // namespace
}  // namespace sumogamma::osm
