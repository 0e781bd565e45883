#include "osm/repairs/round_bends.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/vec2.h"
#include "osm/repairs/coarse_rings.h"
#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

const Tags kTertiary = {{"highway", "tertiary"}};

class RoundBendsTest : public ::testing::Test {
 protected:
  void round() { round_bends(b.map, b.log); }
  std::vector<Vec2> line(std::int64_t way) const {
    std::vector<Vec2> points;
    for (const std::int64_t node : b.find_way(way)->nodes)
      points.emplace_back(b.east(node), b.north(node));
    return points;
  }
  /// Greatest angle by which the line turns at one of its points [deg].
  double sharpest(std::int64_t way) const {
    const std::vector<Vec2> p = line(way);
    double most = 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const Vec2 a = (p[i] - p[i - 1]).normalized(), c = (p[i + 1] - p[i]).normalized();
      most = std::max(most, std::acos(std::clamp(a.dot(c), -1.0, 1.0)) * 180 / kPi);
    }
    return most;
  }
  MapBuilder b;
};

/*   4 (100 m)
     |
     3
      \
       2 -- 1 (200 m)       a bend of a right angle, cut once: as a ramp in Monaco is drawn */
TEST_F(RoundBendsTest, ABendDrawnWithCornersGetsARadius) {
  b.node(1, 200, 0).node(2, 110, 0).node(3, 100, 10).node(4, 100, 100);
  b.way(10, {1, 2, 3, 4}, kTertiary);
  round();
  EXPECT_LT(sharpest(10), 12.0) << "a circle of 15 m, drawn to 5 cm, turns by 9 at a point";
  EXPECT_EQ(b.log.count("bends_rounded"), 1);
  const std::vector<Vec2> rounded = line(10);
  EXPECT_THAT(b.find_way(10)->nodes, ::testing::IsSupersetOf({1, 2, 3, 4}));
  EXPECT_NEAR(b.east(1), 200, 1e-6);
  EXPECT_NEAR(b.north(4), 100, 1e-6);
  for (std::size_t i = 0; i + 1 < rounded.size(); ++i) {
    EXPECT_GE(rounded[i].x(), rounded[i + 1].x() - 1e-6) << "no point out of its order";
    EXPECT_LE(rounded[i].y(), rounded[i + 1].y() + 1e-6);
  }
  // to both sides alike
  EXPECT_NEAR(b.east(2) - 100, b.north(3), 0.02);
}

TEST_F(RoundBendsTest, NoPointMovesByMoreThanFourMetres) {
  b.node(1, 200, 0).node(2, 100, 0).node(3, 100, 100).way(10, {1, 2, 3}, kTertiary);
  round();
  const double moved = Vec2(b.east(2) - 100, b.north(2)).norm();
  EXPECT_LT(moved, 4.0) << "a circle of 15 m would lie 6 m off";
  EXPECT_GT(moved, 3.0);
  EXPECT_GT(b.east(2), 100.0) << "towards the inside";
}

/*      .-- 3 ---- 4 (200 m)
      2
       '-- 1 ---- 5 (200 m)     8 m apart: no car turns in its lane there */
TEST_F(RoundBendsTest, AHairpinBecomesABulb) {
  b.node(5, 200, 0).node(1, 20, 0).node(2, 16, 4).node(3, 20, 8).node(4, 200, 8);
  b.way(10, {5, 1, 2, 3, 4}, kTertiary);
  round();
  double low = 0, high = 0;
  for (const Vec2& point : line(10)) {
    low = std::min(low, point.y());
    high = std::max(high, point.y());
  }
  EXPECT_LT(sharpest(10), 40.0);
  EXPECT_GT(high - low, 10.5) << "wider than its legs are apart";
  EXPECT_NEAR(b.east(2), 16, 4.0);
  EXPECT_NEAR(b.north(2), 4, 0.1);
}

TEST_F(RoundBendsTest, WhatTurnsGentlyOrHardlyMovesStays) {
  b.node(1, 0, 0).node(2, 100, 0).node(3, 190, 30).node(4, 250, 90);  // 18 and 27 degrees
  b.way(10, {1, 2, 3, 4}, kTertiary);
  const std::vector<Vec2> before = line(10);
  round();
  EXPECT_THAT(b.find_way(10)->nodes, ElementsAre(1, 2, 3, 4));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR((line(10)[i] - before[i]).norm(), 0, 1e-6);
  EXPECT_EQ(b.log.count("bends_rounded"), 0);
}

TEST_F(RoundBendsTest, JunctionsAndTheirMouthsStay) {
  b.node(1, 200, 0).node(2, 100, 0).node(3, 100, 100).node(4, 0, 0);
  b.way(10, {1, 2, 3}, kTertiary).way(11, {2, 4}, kTertiary);  // three roads meet in the corner
  b.node(5, 0, 200).node(6, 0, 212).node(7, 100, 212).way(12, {5, 6, 7}, kTertiary);
  round();
  EXPECT_THAT(b.find_way(10)->nodes, SizeIs(3));
  EXPECT_NEAR(b.east(6), 0, 1e-6) << "12 m from the end of the road";
  EXPECT_EQ(b.log.count("bends_rounded"), 0);
}

TEST_F(RoundBendsTest, ABendGoesOnOverTheEndsOfWays) {
  b.node(1, 200, 0).node(2, 100, 0).node(3, 100, 100).node(4, 60, -40);
  b.way(10, {1, 2}, kTertiary).way(11, {3, 2}, kTertiary);
  b.way(12, {2, 4}, {{"highway", "footway"}});
  round();
  EXPECT_GT(b.east(2), 102.0);
  EXPECT_EQ(b.find_way(10)->nodes.front(), 1);
  EXPECT_EQ(b.find_way(10)->nodes.back(), 2);
  EXPECT_EQ(b.find_way(11)->nodes.front(), 3) << "the order of its nodes stays";
  EXPECT_EQ(b.find_way(11)->nodes.back(), 2);
  for (const std::int64_t way : {10, 11}) {
    const std::vector<Vec2> points = line(way);
    EXPECT_GT(points.size(), 3u);
    for (std::size_t i = 1; i < points.size(); ++i)
      EXPECT_LT((points[i] - points.back()).norm(), (points[i - 1] - points.back()).norm());
  }
  EXPECT_THAT(b.find_way(12)->nodes, ElementsAre(2, 4)) << "the footway moves along";
}

TEST_F(RoundBendsTest, RoundaboutsAreDrawnRoundAndPathsStay) {
  b.node(1, 0, 0).node(2, 40, 0).node(3, 40, 40).node(4, 0, 40).node(5, 150, 0).node(6, -80, 0);
  b.way(10, {1, 2, 3, 4, 1}, {{"highway", "tertiary"}, {"junction", "roundabout"}});
  b.way(11, {2, 5}, kTertiary).way(12, {6, 1}, kTertiary);
  b.node(7, 300, 0).node(8, 400, 0).node(9, 400, 100).way(13, {7, 8, 9}, {{"highway", "footway"}});
  round();
  round_coarse_rings(b.map, b.log);
  EXPECT_THAT(b.find_way(10)->nodes, ::testing::IsSupersetOf({1, 2, 3, 4}));
  for (const Vec2& point : line(10))
    EXPECT_NEAR((point - Vec2(20, 20)).norm(), std::sqrt(800), 0.1);
  EXPECT_LT(sharpest(10), 16.0);
  EXPECT_THAT(b.find_way(11)->nodes, SizeIs(2));
  EXPECT_THAT(b.find_way(13)->nodes, SizeIs(3));
  EXPECT_EQ(b.log.count("bends_rounded"), 0);
  EXPECT_EQ(b.log.count("rings_rounded"), 4);
}

const Tags kCycleway = {{"highway", "cycleway"}};

// whose lanes are a metre wide: at a corner bicycles swing over the one that comes towards them
TEST_F(RoundBendsTest, ACyclewayGetsTheRadiusOfBicycles) {
  b.node(1, 0, 0).node(2, 40, 0).node(3, 40, 30).node(4, 70, 30);
  b.way(10, {1, 2, 3, 4}, kCycleway);
  b.node(5, 0, 100).node(6, 40, 100).node(7, 40, 106).node(8, 80, 106).way(11, {5, 6}, kCycleway);
  b.way(12, {6, 7, 8}, kCycleway);
  round();
  EXPECT_LT(sharpest(10), 25.0);
  EXPECT_LT(Vec2(b.east(2) - 40, b.north(2)).norm(), 2.5) << "5 m, where a road would get 15";
  EXPECT_GT(sharpest(11) + sharpest(12), 0.0);
  EXPECT_EQ(b.find_way(12)->nodes.front(), 6) << "goes on over the ends of ways";
  EXPECT_EQ(b.log.count("bends_rounded"), 2);
}

TEST_F(RoundBendsTest, ACyclewayStaysWhereItMeetsOtherWays) {
  // before a road netconvert shapes the junction by the first points of what meets there
  b.node(1, 0, 0).node(2, 40, 0).node(3, 40, 12).node(4, 0, 12).node(5, 80, 12);
  b.way(10, {1, 2, 3}, kCycleway).way(11, {4, 3, 5}, kTertiary);
  // a footway joins at the corner
  b.node(6, 0, 100).node(7, 40, 100).node(8, 40, 140).node(9, 80, 100);
  b.way(12, {6, 7, 8}, kCycleway).way(13, {7, 9}, {{"highway", "footway"}});
  round();
  EXPECT_THAT(b.find_way(10)->nodes, ElementsAre(1, 2, 3));
  EXPECT_NEAR(b.east(2), 40, 1e-6);
  EXPECT_THAT(b.find_way(12)->nodes, ElementsAre(6, 7, 8));
  EXPECT_EQ(b.log.count("bends_rounded"), 0);
}

// a loop road begins and ends in one junction
TEST_F(RoundBendsTest, ALoopIsRoundedOnce) {
  b.node(1, 0, 0).node(2, 100, 0).node(3, 100, 100).node(4, 0, 100).node(5, -100, 0);
  b.way(10, {1, 2, 3}, kTertiary).way(11, {3, 4, 1}, kTertiary).way(12, {5, 1}, kTertiary);
  round();
  EXPECT_EQ(b.log.count("bends_rounded"), 1);
  EXPECT_LT(sharpest(10), 20.0);
  EXPECT_NEAR(b.east(1), 0, 1e-6);
}

}  // namespace
}  // namespace sumogamma::osm
