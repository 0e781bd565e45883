#include "scene/storey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "road/lane_crossings.h"
#include "road/overpasses.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

class StoreyTest : public ::testing::Test {
 protected:
  // what heights and layers say, as where a road ends near the crossing
  StoreyTest() { net_.overpasses.clear(); }
  Ground at(const char* lane, double along, double height) const {
    return {net_.lane_by_name.at(lane), along, height};
  }
  bool apart(const Ground& a, const Ground& b) {
    find_lane_crossings(net_);
    EXPECT_EQ(on_other_storey(net_, a, b), on_other_storey(net_, b, a));
    return on_other_storey(net_, a, b);
  }
  RoadNetwork net_ = testing::small_net();
};

TEST_F(StoreyTest, ABridgeIsAboveWhatItCrosses) {
  EXPECT_TRUE(apart(at("in_1", 50, 0), at("bridge_0", 60, 6)));
}

// netconvert joins lanes of a junction whose heights differ by metres: no road climbs like that
TEST_F(StoreyTest, LanesThatAFewMetresOfRoadJoinAreNot) {
  EXPECT_FALSE(apart(at("in_1", 90, 0), at(":C_0_0", 5, 4)));
  EXPECT_FALSE(apart(at("in_1", 90, 0), at("out_0", 10, 4)));
  EXPECT_FALSE(apart(at("in_0", 80, 0), at("in_1", 85, 4))) << "of one edge";
  EXPECT_TRUE(apart(at("in_1", 20, 0), at("out_0", 60, 4))) << "a way of 140 m";
}

TEST_F(StoreyTest, WhereLanesCrossTheHeightThereCounts) {
  // on a ramp to the bridge, hardly above the road yet
  EXPECT_TRUE(apart(at("in_1", 50, 0), at("bridge_0", 45, 2)));
  for (double& height : net_.lanes[index_of(net_.lane_by_name.at("bridge_0"))].elevation)
    height = 0.5;
  EXPECT_FALSE(apart(at("in_1", 50, 0), at("bridge_0", 20, 3))) << "it comes down to the road";
}

// netconvert gives heights to the ends of a road only, and those may be of other bridges
TEST_F(StoreyTest, WhereRoadsOfDifferentLayersCrossNoHeightCounts) {
  EXPECT_FALSE(apart(at("in_1", 50, 0), at("bridge_0", 60, 0)));
  net_.lanes[index_of(net_.lane_by_name.at("bridge_0"))].layer = -4;
  net_.has_layers = true;
  EXPECT_TRUE(apart(at("in_1", 50, 0), at("bridge_0", 60, 0)));
  EXPECT_FALSE(apart(at("in_1", 90, 0), at(":C_0_0", 5, 0)));
  net_.lanes[index_of(net_.lane_by_name.at("out_0"))].layer = 1;
  EXPECT_FALSE(apart(at("in_1", 20, 0), at("out_0", 60, 0))) << "they don't cross";
}

// a ramp that ends over a tunnel, at a seam of two lanes: the crossing is on one of them only
TEST_F(StoreyTest, ACrossingBehindTheEndOfTheLaneCounts) {
  const Lane& bridge = net_.lane(net_.lane_by_name.at("bridge_0"));
  Lane& road = net_.lanes[index_of(net_.lane_by_name.at("in_1"))];
  const ConnectionId onward = road.outgoing.front();
  LaneId next = net_.connection(onward).via;
  if (next == kNoLane) next = net_.connection(onward).to;
  Lane& behind = net_.lanes[index_of(next)];
  const double x = bridge.centerline.points().front().x();
  const double over = bridge.centerline.project({x, 0}).along;
  const Ground above{net_.lane_by_name.at("bridge_0"), over, 2};
  behind.elevation = {0, 0};
  // what the road leads into passes below the bridge, or begins there, with a gap
  for (const double begin : {x - 2.0, x + 0.1}) {
    road.centerline = Polyline({{0, 0}, {std::min(begin, x - 0.1), 0}});
    behind.centerline = Polyline({{begin, 0}, {x + 8, 0}});
    EXPECT_TRUE(apart(at("in_1", x - 4, 0), above)) << begin;
  }
}

// two junctions with 10 cm of road between them over a tunnel: a car on the second was taken for
// somebody in the tunnel, 0.4 m deep in a car there
TEST_F(StoreyTest, ACrossingBeforeTheJunctionBehindCounts) {
  const Lane& bridge = net_.lane(net_.lane_by_name.at("bridge_0"));
  const double x = bridge.centerline.points().front().x();
  const Ground above{net_.lane_by_name.at("bridge_0"), bridge.centerline.project({x, 0}).along, 2};
  Lane& road = net_.lanes[index_of(net_.lane_by_name.at("in_1"))];
  const Connection& link = net_.connection(road.outgoing.front());
  ASSERT_NE(link.via, kNoLane);
  Lane& out = net_.lanes[index_of(link.to)];
  road.centerline = Polyline({{0, 0}, {x + 2, 0}});
  net_.lanes[index_of(link.via)].centerline = Polyline({{x + 2, 0}, {x + 4, 0}});
  out.centerline = Polyline({{x + 4, 0}, {x + 60, 0}});
  EXPECT_TRUE(apart({link.to, 3, 0}, above));
  EXPECT_FALSE(apart({link.to, 30, 0}, above)) << "heights alone don't tell";
}

TEST_F(StoreyTest, WhereRoadsCrossWithNoJunctionNeitherHeightsNorLayersCount) {
  Lane& bridge = net_.lanes[index_of(net_.lane_by_name.at("bridge_0"))];
  bridge.elevation = {0, 0};
  find_overpasses(net_);
  EXPECT_TRUE(apart(at("in_1", 50, 0), at("bridge_0", 60, 0)));
  EXPECT_TRUE(apart(at("in_0", 55, 0), at("bridge_0", 52, 0))) << "nor its sidewalk";
  EXPECT_FALSE(apart(at("in_1", 50, 0), at("bridge_0", 5, 0))) << "far from the crossing";
  EXPECT_FALSE(apart(at("in_1", 50, 0), at("in_0", 50, 0)));
}

TEST_F(StoreyTest, ARoadThatWindsOverItselfIsAboveItself) {
  Lane& helix = net_.lanes[index_of(net_.lane_by_name.at("bridge_0"))];
  helix.elevation = {-5, -5, -5, -5, -5};
  helix.centerline = Polyline({{0, 100}, {60, 100}, {60, 140}, {30, 140}, {30, 60}});
  find_overpasses(net_);
  EXPECT_TRUE(apart(at("bridge_0", 28, -5), at("bridge_0", 172, -5)));
  EXPECT_FALSE(apart(at("bridge_0", 28, -5), at("bridge_0", 60, -5))) << "a way of 32 m";
  EXPECT_FALSE(apart(at("bridge_0", 165, -5), at("bridge_0", 175, -5)));
}

// a ramp down to a tunnel joins the road over it within 40 m
TEST_F(StoreyTest, NearAnOverpassTheShorterWayCounts) {
  Lane& loop = net_.lanes[index_of(net_.lane_by_name.at("bridge_0"))];
  loop.elevation = {0, 0, 0, 0, 0};
  loop.centerline = Polyline({{0, 100}, {42, 100}, {42, 112}, {30, 112}, {30, 60}});
  find_overpasses(net_);
  EXPECT_TRUE(apart(at("bridge_0", 40, 0), at("bridge_0", 68, 0))) << "20 m over the crossing";
  EXPECT_FALSE(apart(at("bridge_0", 50, 0), at("bridge_0", 60, 0))) << "10 m by road";
}

TEST_F(StoreyTest, OffEveryLaneTheGroundDecides) {
  const Ground nowhere{kNoLane, 0, 0};
  EXPECT_TRUE(apart(nowhere, at("bridge_0", 60, 6)));
  EXPECT_FALSE(apart(nowhere, at("bridge_0", 60, 2)));
}

}  // namespace
}  // namespace sumogamma
