#include "osm/repairs/coarse_rings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

const Tags kRing = {{"highway", "primary"}, {"junction", "roundabout"}};

/*      2
      /   \
     3     1    a ring of 15 m, drawn as a square
      \   /
        4                                          */
class CoarseRings : public ::testing::Test {
 protected:
  void SetUp() override { b.node(1, 15, 0).node(2, 0, 15).node(3, -15, 0).node(4, 0, -15); }
  double from_middle(GeoPoint place) const {
    const LocalMetric metric(b.at(0, 0));
    return std::hypot(metric.east(place), metric.north(place));
  }
  MapBuilder b;
};

TEST_F(CoarseRings, ASquareBecomesACircleThroughItsCorners) {
  b.way(10, {1, 2, 3, 4, 1}, kRing);
  const std::vector<RingArc> arcs = coarse_ring_arcs(b.map);
  ASSERT_THAT(arcs, SizeIs(4));
  for (const RingArc& arc : arcs) {
    EXPECT_THAT(arc.between, SizeIs(5)) << "a point each 15 degrees";
    for (const GeoPoint place : arc.between) EXPECT_NEAR(from_middle(place), 15.0, 0.01);
  }
  EXPECT_EQ(arcs[0].from, 1);
  EXPECT_EQ(arcs[0].to, 2);
}

TEST_F(CoarseRings, ARingMayConsistOfSeveralWaysAndTurnEitherWay) {
  b.way(10, {1, 4, 3}, kRing).way(11, {3, 2}, kRing).way(12, {2, 1}, kRing);
  EXPECT_THAT(coarse_ring_arcs(b.map), SizeIs(4));
}

TEST_F(CoarseRings, OnlyArcsThatLeaveTheRingByAMetreAreDrawn) {
  for (int id = 5; id < 13; ++id) {
    const double angle = radians(90.0 + 30.0 * (id - 4));
    b.node(id, 15.0 * std::cos(angle), 15.0 * std::sin(angle));
  }
  b.way(10, {1, 2, 5, 6, 7, 8, 9, 10, 11, 12, 1}, kRing);
  const std::vector<RingArc> arcs = coarse_ring_arcs(b.map);
  ASSERT_THAT(arcs, SizeIs(1));
  EXPECT_EQ(arcs[0].to, 2);
}

TEST_F(CoarseRings, WhatIsNoRingStays) {
  b.way(10, {1, 2, 3, 4}, kRing);
  EXPECT_THAT(coarse_ring_arcs(b.map), IsEmpty()) << "open";
  b.map.ways.clear();
  b.way(10, {1, 2, 3, 4, 1}, {{"highway", "primary"}});
  EXPECT_THAT(coarse_ring_arcs(b.map), IsEmpty()) << "a block";
  b.map.ways.clear();
  b.way(10, {1, 3, 2, 4, 1}, kRing);
  EXPECT_THAT(coarse_ring_arcs(b.map), IsEmpty()) << "to and fro";
}

}  // namespace
}  // namespace sumogamma::osm
