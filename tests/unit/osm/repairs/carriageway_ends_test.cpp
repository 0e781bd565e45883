#include "osm/repairs/carriageway_ends.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

const Tags kOneWay = {{"highway", "primary"}, {"oneway", "yes"}, {"name", "Ring"}};

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

}  // namespace
}  // namespace sumogamma::osm
