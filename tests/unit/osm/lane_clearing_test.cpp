#include "osm/lane_clearing.h"

#include <gtest/gtest.h>

namespace sumogamma::osm {
namespace {

/// Width of the ground that a sidewalk 3 m wide needs at some height [m].
double cleared(double height) {
  RoadNetwork road;
  Lane& lane = road.lanes.emplace_back();
  lane.allowed = vehicle_class::kPedestrian;
  lane.width = 3;
  lane.centerline = Polyline({{0, 0}, {20, 0}});
  lane.elevation = {height, height};
  const auto stretches = LaneClearing(road).stretches_on_lanes({10, -5}, {10, 5});
  return stretches.size() == 1 ? 10 * (stretches[0].to - stretches[0].from) : 0.0;
}

TEST(LaneClearing, ASidewalkNeedsItsMiddleAndATunnelMoreThanItsWidth) {
  EXPECT_NEAR(cleared(0), 1.6, 1e-6) << "people abreast get past who comes towards them";
  EXPECT_NEAR(cleared(2), 1.6, 1e-6) << "a ramp between walls";
  EXPECT_NEAR(cleared(-5), 6.0, 1e-6) << "the house over the tunnel isn't in it";
  EXPECT_NEAR(cleared(5), 6.0, 1e-6);
}

}  // namespace
}  // namespace sumogamma::osm
