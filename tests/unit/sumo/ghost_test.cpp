#include "sumo/ghost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/error.h"

namespace sumogamma {
namespace {

TEST(WrappedDegrees, LiesInOneTurn) {
  EXPECT_DOUBLE_EQ(wrapped_degrees(0), 0);
  EXPECT_DOUBLE_EQ(wrapped_degrees(360), 0);
  EXPECT_DOUBLE_EQ(wrapped_degrees(-90), 270);
  EXPECT_DOUBLE_EQ(wrapped_degrees(725), 5);
  for (const double angle : {1e9, -1e9, 1e300, -1e-300, -1e-15, 359.9999999999999}) {
    EXPECT_GE(wrapped_degrees(angle), 0) << angle;
    EXPECT_LT(wrapped_degrees(angle), 360) << angle;
  }
}

TEST(RequireFinitePose, TellsWhoseBugItIs) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(require_finite_pose("a", Vec2(1e9, -1e9), 1e9));
  EXPECT_THROW(require_finite_pose("a", Vec2(kNan, 0), 0), std::logic_error);
  EXPECT_THROW(require_finite_pose("a", Vec2(0, -kInfinity), 0), std::logic_error);
  EXPECT_THROW(require_finite_pose("a", Vec2(0, 0), 0, kNan), std::logic_error);
  try {
    require_finite_pose("truck 7", Vec2(0, 0), kInfinity);
    FAIL();
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("truck 7"), std::string::npos);
  }
}

GhostObservation observation(double x, double angle, std::string lane = "",
                             std::vector<std::string> route = {"a", "b"}) {
  return {Vec2(x, 0), angle, std::move(lane), std::move(route)};
}

TEST(GhostFault, WantsExactPoseNoLaneAndTheRouteKept) {
  const GhostObservation sent = observation(5, 10);
  EXPECT_EQ(ghost_fault(GhostMode::OffLane, false, sent, observation(5, 370)), "");
  EXPECT_NE(ghost_fault(GhostMode::OffLane, false, sent, observation(5.001, 10)), "");
  EXPECT_NE(ghost_fault(GhostMode::OffLane, false, sent, observation(std::nan(""), 10)), "");
  EXPECT_NE(ghost_fault(GhostMode::OffLane, false, sent, observation(5, 12)), "");
  EXPECT_NE(ghost_fault(GhostMode::OffLane, false, sent, observation(5, 10, "a_0")), "");
  EXPECT_EQ(ghost_fault(GhostMode::OnLane, false, sent, observation(5, 10, "a_0")), "");
  EXPECT_EQ(ghost_fault(GhostMode::OffLane, true, sent, observation(5, 10, "a_0", {})), "");
  EXPECT_NE(ghost_fault(GhostMode::OffLane, false, sent, observation(5, 10, "", {"c"})), "");
}

TEST(GhostSelfTest, PassesOnce) {
  GhostSelfTest test(false);
  EXPECT_TRUE(test.pending());
  EXPECT_EQ(test.judge(observation(5, 10), observation(5, 10)), "");
  EXPECT_FALSE(test.pending());
  EXPECT_EQ(test.mode(), GhostMode::OffLane);
}

TEST(GhostSelfTest, FallsBackToLanesAndTestsThemToo) {
  GhostSelfTest test(false);
  EXPECT_NE(test.judge(observation(5, 10), observation(5, 10, "a_0")), "");
  EXPECT_EQ(test.mode(), GhostMode::OnLane);
  EXPECT_TRUE(test.pending());
  EXPECT_EQ(test.judge(observation(6, 10), observation(6, 10, "a_0")), "");
  EXPECT_FALSE(test.pending());
  EXPECT_EQ(test.mode(), GhostMode::OnLane);
  EXPECT_EQ(ghost_arguments(test.mode()).keep_route, 3);
  EXPECT_GT(ghost_arguments(test.mode()).match_threshold, 0);
}

TEST(GhostSelfTest, PersonsThatIgnorePosesAreTheUsersModel) {
  GhostSelfTest test(true);
  EXPECT_NE(test.judge(observation(5, 10), observation(7, 10)), "");
  EXPECT_THROW(test.judge(observation(5, 10), observation(7, 10)), Error);
}

}  // namespace
}  // namespace sumogamma
