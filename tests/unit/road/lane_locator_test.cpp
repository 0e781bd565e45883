#include "road/lane_locator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

class LaneLocatorTest : public ::testing::Test {
 protected:
  std::vector<std::string> names_at(const Vec2& point) const {
    std::vector<LaneHit> hits;
    locator_.find_containing(point, hits);
    std::vector<std::string> names;
    for (const LaneHit& hit : hits) names.push_back(net_.lane(hit.lane).name);
    return names;
  }
  std::string nearest_name(const Vec2& point, VehicleClassMask classes, double heading = 0,
                           double reach = 20) const {
    const LaneHit hit = locator_.find_nearest(point, classes, heading, reach);
    return hit.lane == kNoLane ? "" : net_.lane(hit.lane).name;
  }

  RoadNetwork net_ = testing::small_net();
  LaneLocator locator_{net_};
};

using Names = std::vector<std::string>;

TEST_F(LaneLocatorTest, FindsEveryLaneOfAPlace) {
  EXPECT_EQ(names_at({20, 0.5}), Names{"in_1"});
  EXPECT_EQ(names_at({20, 3}), Names{"in_0"});
  EXPECT_EQ(names_at({50, -3}), (Names{"back_0", "bridge_0"}));
  EXPECT_EQ(names_at({101, 0}), (Names{":C_0_0", ":C_c0_0"}));
  EXPECT_EQ(names_at({101, 4}), Names{":C_w0_0"});
  EXPECT_EQ(names_at({20, 30}), Names{});
  EXPECT_EQ(names_at({1e9, std::nan("")}), Names{});
}

TEST_F(LaneLocatorTest, ALaneEndsWhereItEnds) {
  EXPECT_EQ(names_at({94.8, 0}), Names{"in_1"});
  EXPECT_EQ(names_at({-0.5, 0}), Names{});
}

TEST_F(LaneLocatorTest, ReportsAlongAndOffset) {
  std::vector<LaneHit> hits;
  locator_.find_containing({20, -3.0}, hits);
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_NEAR(hits[0].along, 75.0, 1e-12);
  EXPECT_NEAR(hits[0].offset, -0.2, 1e-12);  // heading west, north of the centreline is right
  EXPECT_NEAR(hits[0].direction.x(), -1.0, 1e-12);
}

TEST_F(LaneLocatorTest, NearestRespectsClassesHeadingAndReach) {
  EXPECT_EQ(nearest_name({20, 10}, vehicle_class::kPassenger), "in_1");
  EXPECT_EQ(nearest_name({20, 10}, vehicle_class::kPedestrian), "in_0");
  EXPECT_EQ(nearest_name({20, 60}, vehicle_class::kPedestrian), "");
  EXPECT_EQ(nearest_name({20, 60}, vehicle_class::kPedestrian, 0, 100), "in_0");
  EXPECT_EQ(nearest_name({50, 0}, vehicle_class::kPassenger, 0), "in_1");
  EXPECT_EQ(nearest_name({50, 0}, vehicle_class::kPassenger, kPi / 2), "bridge_0");
  EXPECT_EQ(nearest_name({-300, 0}, vehicle_class::kPassenger, 0, 1000), "in_1");
}

TEST_F(LaneLocatorTest, KnowsJunctionGround) {
  EXPECT_TRUE(locator_.on_junction({100, 0}));
  EXPECT_FALSE(locator_.on_junction({94, 0}));
}

TEST_F(LaneLocatorTest, AgreesWithASearchOverAllLanes) {
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const Vec2 point(random_uniform(1, i, 0, Draw::Demand, -5, 205),
                     random_uniform(2, i, 0, Draw::Demand, -12, 8));
    Names expected;
    for (const Lane& lane : net_.lanes) {
      if (lane.kind == LaneKind::WalkingArea) {
        if (ring_contains(lane.outline, point)) expected.push_back(lane.name);
        continue;
      }
      const auto& points =
          lane.centerline.points();  // every lane of this net is one straight segment
      const Vec2 local =
          to_body(point - points.front(), (points.back() - points.front()).normalized());
      if (std::abs(local.y()) <= 0.5 * lane.width && local.x() >= -LaneLocator::kEndTolerance &&
          local.x() <= lane.centerline.length() + LaneLocator::kEndTolerance)
        expected.push_back(lane.name);
    }
    EXPECT_EQ(names_at(point), expected) << point.transpose();
  }
}

TEST(Ring, DegenerateRingsContainNothing) {
  EXPECT_FALSE(ring_contains({}, {0, 0}));
  const std::vector<Vec2> line{{0, 0}, {1, 1}};
  EXPECT_FALSE(ring_contains(line, {0.5, 0.25}));
  EXPECT_TRUE(std::isinf(distance_to_ring({}, {0, 0})));
}

TEST(LaneLocatorEmpty, AnswersNothing) {
  const RoadNetwork empty;
  const LaneLocator locator(empty);
  std::vector<LaneHit> hits{LaneHit{}};
  locator.find_containing({0, 0}, hits);
  EXPECT_TRUE(hits.empty());
  EXPECT_FALSE(locator.on_junction({0, 0}));
  EXPECT_EQ(locator.find_nearest({0, 0}, vehicle_class::kAll, 0).lane, kNoLane);
}

}  // namespace
}  // namespace sumogamma
