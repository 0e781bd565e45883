#include "osm/repairs/travelled_ways.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "osm/repairs/closed_roads.h"
#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

/// A street of 200 m with the given tags; its highway value after both, "" where it was
/// dropped.
std::string kept_as(Tags tags) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 200, 0).way(10, {1, 2}, std::move(tags));
  drop_untravelled(b.map, b.log);
  close_to_motors(b.map, b.log);
  return b.map.ways.empty() ? "" : tag(b.map.ways[0].tags, "highway");
}

TEST(TravelledWays, KeepsWhatIsOpenAndDropsWhatIsNot) {
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

}  // namespace
}  // namespace sumogamma::osm
