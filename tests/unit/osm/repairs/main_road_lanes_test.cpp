#include "osm/repairs/main_road_lanes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "osm/repairs/circular_junctions.h"
#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

TEST(MainRoadLanes, GuessesLanesOfTwoWayMainRoadsOnly) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 100, 0);
  b.way(10, {1, 2}, {{"highway", "primary"}})
      .way(11, {1, 2}, {{"highway", "primary"}, {"oneway", "yes"}});
  b.way(12, {1, 2}, {{"highway", "primary"}, {"lanes", "4"}})
      .way(13, {1, 2}, {{"highway", "tertiary"}});
  b.way(14, {1, 2}, {{"highway", "primary"}, {"junction", "circular"}});
  guess_main_road_lanes(b.map, b.log);
  EXPECT_EQ(tag(b.find_way(10)->tags, "lanes"), "2");
  EXPECT_EQ(tag(b.find_way(11)->tags, "lanes"), "");
  EXPECT_EQ(tag(b.find_way(12)->tags, "lanes"), "4");
  EXPECT_EQ(tag(b.find_way(13)->tags, "lanes"), "");
  EXPECT_EQ(tag(b.find_way(14)->tags, "lanes"), "");
  mark_circular_as_roundabout(b.map, b.log);
  EXPECT_EQ(tag(b.find_way(14)->tags, "junction"), "roundabout");
}

}  // namespace
}  // namespace sumogamma::osm
