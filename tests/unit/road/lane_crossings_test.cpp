#include "road/lane_crossings.h"

#include <gtest/gtest.h>

#include "support/small_net.h"

namespace sumogamma {
namespace {

class LaneCrossingsTest : public ::testing::Test {
 protected:
  LaneId id(const char* lane) const { return net_.lane_by_name.at(lane); }
  Lane& lane(const char* name) { return net_.lanes[index_of(id(name))]; }
  const LaneCrossing* found(const char* one, const char* other) {
    find_lane_crossings(net_);
    const LaneCrossing* there = crossing_with(lane(one), id(other));
    const LaneCrossing* back = crossing_with(lane(other), id(one));
    EXPECT_EQ(there != nullptr, back != nullptr);
    EXPECT_TRUE(!there || !back || there->apart == back->apart);
    return there;
  }
  RoadNetwork net_ = testing::small_net();
};

TEST_F(LaneCrossingsTest, ABridgeIsApartFromWhatItCrosses) {
  ASSERT_TRUE(found("in_1", "bridge_0"));
  EXPECT_TRUE(found("in_1", "bridge_0")->apart);
  EXPECT_FALSE(found("in_1", "in_0")) << "side by side";
  EXPECT_FALSE(found("out_0", "bridge_0")) << "far away";
}

TEST_F(LaneCrossingsTest, HeightsAtTheCrossingCountOrLayers) {
  lane("bridge_0").elevation = {1, 1};
  EXPECT_FALSE(found("in_1", "bridge_0")->apart);
  lane("bridge_0").layer = 1;
  net_.has_layers = true;
  EXPECT_TRUE(found("in_1", "bridge_0")->apart);
}

TEST_F(LaneCrossingsTest, LanesReachAMetreBeyondTheirEnds) {
  lane("in_1").centerline = Polyline({{0, 0}, {49.5, 0}});
  EXPECT_TRUE(found("in_1", "bridge_0"));
  lane("in_1").centerline = Polyline({{0, 0}, {48.5, 0}});
  EXPECT_FALSE(found("in_1", "bridge_0"));
}

TEST_F(LaneCrossingsTest, ALineOfManyPointsIsLookedAtWhole) {
  std::vector<Vec2> points;
  for (int k = 0; k <= 95; ++k) points.emplace_back(k, 0.0);
  lane("in_1").centerline = Polyline(points);
  EXPECT_TRUE(found("in_1", "bridge_0"));
}

TEST_F(LaneCrossingsTest, AFlatNetworkHasNone) {
  lane("bridge_0").elevation.clear();
  net_.overpasses.clear();
  EXPECT_FALSE(found("in_1", "bridge_0"));
}

TEST_F(LaneCrossingsTest, NeighboursAreJunctionsWithinFortyMetres) {
  const Junction& signal = net_.junctions[index_of(net_.junction_by_name.at("C"))];
  find_lane_crossings(net_);
  EXPECT_TRUE(signal.neighbours.empty()) << "lanes of 95 m";
  lane("out_0").centerline = Polyline({{105, 0}, {130, 0}});
  find_lane_crossings(net_);
  ASSERT_EQ(signal.neighbours.size(), 1u);
  EXPECT_EQ(net_.junction(signal.neighbours.front().junction).name, "E");
  EXPECT_DOUBLE_EQ(signal.neighbours.front().way, 25.0);
}

}  // namespace
}  // namespace sumogamma
