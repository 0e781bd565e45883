#include "osm/repairs/squares.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using ::testing::SizeIs;

/*      5 (40 m)
        |
    +---2---+       a square with entrances west, north and east
 4--1   .   3--6
    +-------+                                                     */
TEST(ReplaceSquares, ASquareIsCrossedNotRounded) {
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
  replace_squares(b.map, b.log);
  EXPECT_EQ(b.find_way(10), nullptr);
  EXPECT_THAT(b.map.ways, SizeIs(6));  // three approaches, three spokes
  const std::int64_t center = b.map.ways.back().nodes.back();
  EXPECT_NEAR(b.east(center), 0, 0.1);
  EXPECT_NEAR(b.north(center), 0, 0.1);
  EXPECT_EQ(b.log.count("square_crossed"), 1);
}

}  // namespace
}  // namespace sumogamma::osm
