#include "road/overpasses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "support/small_net.h"

namespace sumogamma {
namespace {

class OverpassesTest : public ::testing::Test {
 protected:
  Lane& lane(const char* name) { return net_.lanes[index_of(net_.lane_by_name.at(name))]; }
  std::vector<Overpass>& found() {
    find_overpasses(net_);
    return net_.overpasses;
  }
  RoadNetwork net_ = testing::small_net();
};

TEST_F(OverpassesTest, RoadsThatCrossWithNoJunctionAreAboveOneAnother) {
  for (const double height : {6.0, 0.0}) {
    lane("bridge_0").elevation = {height, height};
    ASSERT_EQ(found().size(), 2u) << "over one carriageway and the other";
    const Overpass& first = found().front();
    EXPECT_EQ(net_.edge(first.one).name, "in");
    EXPECT_EQ(net_.edge(first.other).name, "bridge");
    EXPECT_NEAR(first.along_one, 50.0, 1e-9);
    EXPECT_NEAR(first.along_other, 60.0, 1e-9);
  }
}

TEST_F(OverpassesTest, WhereRoadsEndOrTouchTheyDontCross) {
  lane("bridge_0").centerline = Polyline({{85, -60}, {85, 60}});
  EXPECT_TRUE(found().empty()) << "10 m from the end of both carriageways";
  lane("bridge_0").centerline = Polyline({{5, -20}, {90, 20}});
  EXPECT_TRUE(found().empty()) << "25 degrees";
}

// as the way into a car park (93091321) under a road in Monaco, 11 m before a junction of the road
TEST_F(OverpassesTest, RoadsOfTwoLayersCrossHoweverNearToTheirEnds) {
  lane("bridge_0").centerline = Polyline({{85, -60}, {85, 60}});
  lane("bridge_0").layer = 1;
  EXPECT_EQ(found().size(), 2u);
  Edge& bridge = net_.edges[index_of(lane("bridge_0").edge)];
  bridge.from = net_.edge(lane("in_0").edge).to;
  EXPECT_LT(found().size(), 2u) << "a ramp leaves the road's junction";
}

TEST_F(OverpassesTest, AFootwayMayCrossAtGrade) {
  lane("bridge_0").allowed = vehicle_class::kPedestrian;
  EXPECT_TRUE(found().empty());
}

// a helix: one way of one layer. As the tunnel of 214635479 in Monaco
TEST_F(OverpassesTest, ARoadThatWindsOverItselfIsAboveItself) {
  lane("bridge_0").elevation = {-5, -5, -5, -5, -5};
  lane("bridge_0").centerline = Polyline({{0, 100}, {60, 100}, {60, 140}, {30, 140}, {30, 60}});
  ASSERT_EQ(found().size(), 1u);
  const Overpass& self = found().front();
  EXPECT_EQ(self.one, self.other);
  EXPECT_NEAR(self.along_one, 30.0, 1e-9);
  EXPECT_NEAR(self.along_other, 170.0, 1e-9);
}

// a bus on its way into a tunnel of Monaco, on the junction before it, and a car on the road above
// took each other for being on one storey: netconvert has the ramp descend on its last metres
TEST_F(OverpassesTest, ALinkGoesUnderARoadFromElsewhereThatIsHigher) {
  lane("bridge_0").centerline = Polyline({{100, -60}, {100, 60}});
  lane(":C_0_0").centerline = Polyline({{70, 0}, {130, 0}});
  lane(":C_0_0").elevation = {0, 0};
  lane("bridge_0").elevation = {1, 1};
  EXPECT_TRUE(found().empty()) << "no storey";
  lane("bridge_0").elevation = {2, 2};
  ASSERT_EQ(found().size(), 3u);
  const EdgeId bridge = lane("bridge_0").edge;
  for (const auto& [name, along] :
       {std::pair("in_1", 125.0), std::pair(":C_0_0", 30.0), std::pair("out_0", -30.0)}) {
    const EdgeId edge = lane(name).edge;
    const auto overpass =
        std::find_if(net_.overpasses.begin(), net_.overpasses.end(), [&](const Overpass& each) {
          return std::minmax(each.one, each.other) == std::minmax(edge, bridge);
        });
    ASSERT_NE(overpass, net_.overpasses.end()) << name;
    const bool first = overpass->one == edge;
    EXPECT_NEAR(first ? overpass->along_one : overpass->along_other, along, 1e-9) << name;
    EXPECT_NEAR(first ? overpass->along_other : overpass->along_one, 60.0, 1e-9) << name;
  }
  net_.edges[index_of(bridge)].to = lane(":C_0_0").junction;
  EXPECT_TRUE(found().empty()) << "it comes to the junction";
}

// netconvert's lanes at the inside of a hairpin
TEST_F(OverpassesTest, AFoldIsNoLoop) {
  lane("bridge_0").centerline = Polyline({{0, 100}, {42, 100}, {42, 106}, {36, 106}, {36, 60}});
  EXPECT_TRUE(found().empty());
}

}  // namespace
}  // namespace sumogamma
