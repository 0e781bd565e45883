#include "osm/repairs/crossing_footways.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using ::testing::SizeIs;

TEST(AddFootwaysAtCrossings, OnlyHalfWayAlongARoad) {
  MapBuilder b = crossroads_with_stop_lines();
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
  MapBuilder b = crossroads_with_stop_lines();
  b.map.nodes.at(11).tags = {{"highway", "crossing"}};
  b.node(21, -30, 40).way(120, {21, 11}, {{"highway", "footway"}});
  add_footways_at_crossings(b.map, b.log);
  EXPECT_THAT(b.map.ways, SizeIs(5));
}

}  // namespace
}  // namespace sumogamma::osm
