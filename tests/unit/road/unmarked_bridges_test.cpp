#include "road/unmarked_bridges.h"

#include <gtest/gtest.h>

#include "support/small_net.h"

namespace sumogamma {
namespace {

class UnmarkedBridgesTest : public ::testing::Test {
 protected:
  Lane& lane(const char* name) { return net_.lanes[index_of(net_.lane_by_name.at(name))]; }
  std::vector<UnmarkedBridge>& found() {
    find_unmarked_bridges(net_);
    return net_.unmarked_bridges;
  }
  RoadNetwork net_ = testing::small_net();
};

TEST_F(UnmarkedBridgesTest, RoadsThatCrossWithNoJunctionAreAboveOneAnother) {
  EXPECT_TRUE(found().empty()) << "6 m up: everybody sees that";
  lane("bridge_0").elevation = {0, 0};
  ASSERT_EQ(found().size(), 2u) << "over one carriageway and the other";
  const UnmarkedBridge& first = found().front();
  EXPECT_EQ(net_.edge(first.one).name, "in");
  EXPECT_EQ(net_.edge(first.other).name, "bridge");
  EXPECT_NEAR(first.along_one, 50.0, 1e-9);
  EXPECT_NEAR(first.along_other, 60.0, 1e-9);
}

TEST_F(UnmarkedBridgesTest, LayersTellByThemselves) {
  lane("bridge_0").elevation = {0, 0};
  lane("bridge_0").layer = 1;
  EXPECT_TRUE(found().empty());
}

TEST_F(UnmarkedBridgesTest, WhereRoadsEndOrTouchTheyDontCross) {
  lane("bridge_0").elevation = {0, 0};
  lane("bridge_0").centerline = Polyline({{85, -60}, {85, 60}});
  EXPECT_TRUE(found().empty()) << "10 m from the end of both carriageways";
  lane("bridge_0").centerline = Polyline({{5, -20}, {90, 20}});
  EXPECT_TRUE(found().empty()) << "25 degrees";
}

TEST_F(UnmarkedBridgesTest, AFootwayMayCrossAtGrade) {
  lane("bridge_0").elevation = {0, 0};
  lane("bridge_0").allowed = vehicle_class::kPedestrian;
  EXPECT_TRUE(found().empty());
}

// a helix: one way of one layer. As the tunnel of 214635479 in Monaco
TEST_F(UnmarkedBridgesTest, ARoadThatWindsOverItselfIsAboveItself) {
  lane("bridge_0").elevation = {-5, -5, -5, -5, -5};
  lane("bridge_0").centerline = Polyline({{0, 100}, {60, 100}, {60, 140}, {30, 140}, {30, 60}});
  ASSERT_EQ(found().size(), 1u);
  const UnmarkedBridge& self = found().front();
  EXPECT_EQ(self.one, self.other);
  EXPECT_NEAR(self.along_one, 30.0, 1e-9);
  EXPECT_NEAR(self.along_other, 170.0, 1e-9);
}

}  // namespace
}  // namespace sumogamma
