#include "road/detour.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/road_scene.h"

namespace sumogamma {
namespace {

/// A way over a crossroads that leaves its lane by 2 m to the left between 100 and 120 m.
class DetourTest : public ::testing::Test {
 protected:
  DetourTest()
      : network_(testing::read_plain_net(testing::crossroads("priority"))), here_(network_) {
    const Path& old = lanes();
    for (const double along : {100.0, 108.0, 112.0, 120.0}) {
      const double off = along == 100.0 || along == 120.0 ? 0.0 : 2.0;
      points_.push_back(old.line.point_at(along) + off * left_of(old.line.direction_at(along)));
    }
  }
  const Path& lanes() { return here_.path(row_); }

  RoadNetwork network_;
  testing::RoadScene here_;
  std::size_t row_ = here_.add("car", {"WC", "CE"}, 60, 5, 0, -1, "WC_0");
  std::vector<Vec2> points_;
};

TEST_F(DetourTest, CarriesWhatLiesOnTheWayAlong) {
  const Path& old = lanes();
  const Path path = with_detour(old, 100, 120, points_);
  const double longer = path.line.length() - old.line.length();
  EXPECT_NEAR(longer, 2 * (std::hypot(8, 2) - 8), 1e-6);
  EXPECT_NEAR(path.arrival, old.arrival + longer, 1e-9);
  EXPECT_NEAR(path.links.front().stop_line, old.links.front().stop_line + longer, 1e-9);
  ASSERT_EQ(path.stretches.size(), old.stretches.size());
  EXPECT_EQ(path.stretches.front().from, old.stretches.front().from);
  EXPECT_NEAR(path.stretches.back().to, old.stretches.back().to + longer, 1e-9);
  EXPECT_LT((path.line.point_at(60) - old.line.point_at(60)).norm(), 1e-9);
  EXPECT_LT((path.line.point_at(150 + longer) - old.line.point_at(150)).norm(), 1e-9);
  EXPECT_LT((path.line.point_at(110) - points_[1]).norm(), 2.0);
}

TEST_F(DetourTest, LeavesLessRoomOnTheSideThatItGoesTo) {
  const Path path = with_detour(lanes(), 100, 120, points_);
  EXPECT_NEAR(path.cut_between(110, 110).left, 2.0, 0.01);
  EXPECT_EQ(path.cut_between(110, 110).right, 0.0);
  EXPECT_EQ(path.cut_between(80, 80).left, lanes().cut_between(80, 80).left);
}

TEST_F(DetourTest, IsDrivenNoFasterThanItsBendsAllow) {
  const Path path = with_detour(lanes(), 100, 120, points_);
  EXPECT_LT(path.profile_at(108), lanes().profile_at(108));
  EXPECT_EQ(path.profile_at(20), lanes().profile_at(20));
}

}  // namespace
}  // namespace sumogamma
