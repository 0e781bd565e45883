#include "osm/repairs/doubled_roads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"
#include "support/osm/street_tags.h"

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::IsNull;

const Tags kService = {{"highway", "service"}}, kFootway = {{"highway", "footway"}};

//  1 -- 2 -- 3 -- 4 -- 5   one row of nodes for all
class DoubledRoads : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int id = 1; id <= 5; ++id) b.node(id, 50.0 * id, 0);
  }
  std::vector<std::int64_t> nodes_of(std::int64_t way) {
    const MapWay* found = b.find_way(way);
    return found == nullptr ? std::vector<std::int64_t>{} : found->nodes;
  }
  MapBuilder b;
};

TEST_F(DoubledRoads, TheHigherClassKeepsThePieceAndTheRestOfTheOtherStays) {
  b.way(10, {1, 2, 3, 4, 5}, kService).way(11, {2, 3}, kStreet);
  drop_doubled_roads(b.map, b.log);
  EXPECT_THAT(nodes_of(11), ElementsAre(2, 3));
  EXPECT_THAT(nodes_of(10), ElementsAre(1, 2));
  ASSERT_EQ(b.map.ways.size(), 3U);
  EXPECT_THAT(b.map.ways.back().nodes, ElementsAre(3, 4, 5));
  EXPECT_EQ(b.map.ways.back().tags, kService);
}

TEST_F(DoubledRoads, OfTwoAlikeTheOlderStaysWhicheverWayItIsDrawn) {
  b.way(10, {4, 3, 2}, kStreet).way(11, {1, 2, 3, 4}, kStreet);
  drop_doubled_roads(b.map, b.log);
  EXPECT_THAT(nodes_of(10), ElementsAre(4, 3, 2));
  EXPECT_THAT(nodes_of(11), ElementsAre(1, 2));
}

TEST_F(DoubledRoads, WhatIsWhollyOnTopOfAnotherGoes) {
  b.way(10, {1, 2, 3}, kStreet).way(11, {1, 2, 3}, kStreet);
  drop_doubled_roads(b.map, b.log);
  EXPECT_THAT(b.find_way(11), IsNull());
}

TEST_F(DoubledRoads, OneWayRoadsInOppositeDirectionsBothStay) {
  Tags one_way = kStreet;
  one_way["oneway"] = "yes";
  b.way(10, {1, 2}, one_way).way(11, {2, 1}, one_way).way(12, {1, 2}, one_way);
  drop_doubled_roads(b.map, b.log);
  EXPECT_THAT(nodes_of(10), ElementsAre(1, 2));
  EXPECT_THAT(nodes_of(11), ElementsAre(2, 1));
  EXPECT_THAT(b.find_way(12), IsNull());
}

TEST_F(DoubledRoads, APathStaysOnlyWhereNobodyWalksAlongTheRoadBelowIt) {
  Tags tunnel = kStreet;
  tunnel["sidewalk"] = "no";
  b.way(10, {1, 2}, kStreet).way(11, {2, 3}, tunnel).way(12, {1, 2, 3, 4}, kFootway);
  drop_doubled_roads(b.map, b.log);
  EXPECT_THAT(nodes_of(12), ElementsAre(2, 3, 4));
}

TEST_F(DoubledRoads, MapsWithoutThemStayAsTheyAre) {
  b.way(10, {1, 2, 3}, kStreet).way(11, {3, 4}, kService).way(12, {4, 5, 1}, kFootway);
  drop_doubled_roads(b.map, b.log);
  EXPECT_THAT(nodes_of(10), ElementsAre(1, 2, 3));
  EXPECT_THAT(nodes_of(11), ElementsAre(3, 4));
  EXPECT_THAT(nodes_of(12), ElementsAre(4, 5, 1));
}

}  // namespace
}  // namespace sumogamma::osm
