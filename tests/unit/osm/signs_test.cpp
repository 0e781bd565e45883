#include "osm/signs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::SizeIs;

TEST(FindSigns, TellsWhomTheyFaceByJunction) {
  MapBuilder b = crossroads_with_stop_lines();
  b.map.nodes.at(11).tags = {{"highway", "stop"}};
  b.map.nodes.at(12).tags = {{"highway", "stop"}};
  EXPECT_THAT(find_signs(b.map, "stop", 60),
              ElementsAre(Pair(1, ElementsAre(WayApproach{101, 1}, WayApproach{102, -1}))));
  EXPECT_THAT(find_signs(b.map, "stop", 20), SizeIs(0));
  EXPECT_THAT(find_signs(b.map, "give_way", 60), SizeIs(0));
}

}  // namespace
}  // namespace sumogamma::osm
