#include "osm/repairs/contraflow.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using ::testing::Contains;
using ::testing::Key;
using ::testing::Not;
using ::testing::Pair;

/// Tags of a residential road after rewrite_contraflow().
Tags rewritten(Tags tags, bool left_hand = false) {
  MapBuilder b;
  tags.emplace("highway", "residential");
  b.node(1, 0, 0).node(2, 200, 0).way(10, {1, 2}, std::move(tags));
  rewrite_contraflow(b.map, left_hand, b.log);
  return b.map.ways[0].tags;
}

TEST(RewriteContraflow, GivesBicyclesALaneAgainstTheTraffic) {
  for (const auto& [key, value] :
       {std::pair{"oneway:bicycle", "no"}, std::pair{"cycleway", "opposite"},
        std::pair{"cycleway", "opposite_lane"}, std::pair{"cycleway:left", "opposite_lane"}}) {
    const Tags tags = rewritten({{"oneway", "yes"}, {key, value}});
    EXPECT_THAT(tags, Contains(Pair("cycleway:left", "lane"))) << key << value;
    EXPECT_THAT(tags, Not(Contains(Key("cycleway:right")))) << key << value;
    EXPECT_THAT(tags, Not(Contains(Key("cycleway")))) << key << value;
  }
  EXPECT_THAT(rewritten({{"oneway", "yes"}, {"cycleway", "opposite_track"}}),
              Contains(Pair("cycleway:left", "track")));
  EXPECT_THAT(rewritten({{"oneway", "-1"}, {"oneway:bicycle", "no"}}),
              Contains(Pair("cycleway:right", "lane")));
}

TEST(RewriteContraflow, ALaneOnTheOtherSideLeadsAlongUnlessItIsToldToTurn) {
  const Tags along = rewritten({{"oneway", "yes"}, {"cycleway:left", "lane"}});
  EXPECT_THAT(along, Contains(Pair("cycleway:right", "lane")));
  EXPECT_THAT(along, Not(Contains(Key("cycleway:left"))));
  for (const auto& [key, value] :
       {std::pair{"oneway:bicycle", "no"}, std::pair{"cycleway:left:oneway", "-1"}})
    EXPECT_THAT(rewritten({{"oneway", "yes"}, {"cycleway:left", "track"}, {key, value}}),
                Contains(Pair("cycleway:left", "track")));
}

TEST(RewriteContraflow, BothSides) {
  const Tags tags =
      rewritten({{"oneway", "yes"}, {"cycleway:right", "lane"}, {"oneway:bicycle", "no"}});
  EXPECT_THAT(tags, Contains(Pair("cycleway:right", "lane")));
  EXPECT_THAT(tags, Contains(Pair("cycleway:left", "lane")));
  // where traffic keeps left its own side is the left one
  const Tags left =
      rewritten({{"oneway", "yes"}, {"cycleway:right", "track"}, {"oneway:bicycle", "no"}}, true);
  EXPECT_THAT(left, Contains(Pair("cycleway:left", "track")));
  EXPECT_THAT(left, Not(Contains(Key("cycleway:right"))));
}

TEST(RewriteContraflow, LeavesOtherRoadsAsTheyAre) {
  const Tags two_way = {{"highway", "residential"}, {"cycleway", "lane"}};
  EXPECT_EQ(rewritten(two_way), two_way);
  const Tags one_way = {{"highway", "residential"}, {"oneway", "yes"}};
  EXPECT_EQ(rewritten(one_way), one_way);
  EXPECT_THAT(rewritten({{"oneway", "yes"}, {"oneway:bus", "no"}}),
              Contains(Pair("busway", "opposite_lane")));
}

}  // namespace
}  // namespace sumogamma::osm
