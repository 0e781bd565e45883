#include "traffic/junction/arbitration.h"

#include <gtest/gtest.h>

#include "model/context.h"
#include "model/gamma_velocity.h"
#include "support/junction_scenes.h"
#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::CrossingTest;
using testing::PriorityTest;
using testing::RoadScene;

// a bus came to rest at the edge of the place where their ways cross, took itself for being in
// there, rolled on and met the other nose to nose
TEST_F(PriorityTest, WhoHasComeToRestAtAZonesEdgeWaitsThereForWhoIsInItsWay) {
  const std::size_t own = here_.add("car", {"SC", "CN"}, 0, 0.4);
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 0, 2, 0, -1, "WC_0");
  for (const double past : {-0.2, 0.2}) {
    here_.move(own, zone_of(own, foe) - 2.25 + past);
    const auto waits = [&](double into, double speed) {
      here_.move(foe, zone_of(foe, own) - 2.25 + into);
      here_.set_speed(foe, speed);
      here_.update();
      return here_.context(own).reason == LimitReason::Yield;
    };
    EXPECT_TRUE(waits(4.25, 2.0)) << past;
    // a bus drove on towards a van that stood there for a second and went on, too
    EXPECT_TRUE(waits(4.25, 0.0)) << past << ": who stands in the way";
    EXPECT_FALSE(waits(0.35, 0.0)) << past << ": past who stands beside it";
  }
}

TEST_F(PriorityTest, AStopSignIsHaltedAt) {
  RoadScene here(net_with_stop_signs());
  const std::size_t own = here.add("car", {"SC", "CN"}, 0, 8);
  const double line = here.path(own).links.front().stop_line;
  here.move(own, line - 20);
  here.update();
  EXPECT_EQ(here.context(own).reason, LimitReason::Yield);
  // having stood at the line, it goes
  here.move(own, line - 2.25 - 0.7);
  here.set_speed(own, 0);
  here.scene.held[own].standing = 1.0;
  here.update();
  EXPECT_NE(here.context(own).reason, LimitReason::Yield);
}

TEST_F(PriorityTest, WhoRollsOverAStopSignNeedNotHaltThere) {
  RoadScene here(net_with_stop_signs());
  const std::size_t own = here.add("car", {"SC", "CN"}, 0, 1.8);
  here.scene.manners[own].key = 5;
  const double line = here.path(own).links.front().stop_line;
  const auto waits = [&](double before, double speed, double share) {
    for (AgentType& type : here.model.types) type.compliance.rolling_stops = share;
    here.traffic.halted_for[own] = kNoConnection;
    here.move(own, line - 2.25 - before);
    here.set_speed(own, speed);
    here.update();
    here.update();
    return here.context(own).reason == LimitReason::Yield;
  };
  EXPECT_TRUE(waits(1.0, 1.8, 0.0));
  EXPECT_FALSE(waits(1.0, 1.8, 1.0));
  EXPECT_TRUE(waits(1.0, 4.0, 1.0)) << "too fast to look";
  EXPECT_TRUE(waits(12.0, 1.8, 1.0)) << "too far from the line";
}

//     |  crossing  |
//     |_____^______|      the way turns left onto it: who walks to its left is on the crossing
//   ------> '             before its place on the path is
TEST_F(CrossingTest, WhoWaitsInsideTheCornerWaitsBesideTheCrossing) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.5, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 6, 0, -1, "WC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 2.25 - 9);
  give_priority(here_.path(walker).links.at(0).connection);
  for (AgentType& type : here_.model.types) type.compliance.yielding_rate = 0.0;
  here_.scene.manners[driver].key = 1;
  auto ahead = [&](double offset) {
    here_.move(walker, kerb - 1.2, offset);
    here_.update();
    EXPECT_EQ(here_.context(walker).foe, here_.scene.id[driver].value);
    const Vec2 way = here_.context(walker).sub_goal - here_.scene.position[walker];
    return way.dot(here_.path(walker).line.direction_at(kerb - 1.2));
  };
  EXPECT_GT(ahead(0.0), 0.0);
  EXPECT_LT(ahead(0.8), 0.0);  // steps back
}

TEST_F(CrossingTest, WhoHaltsForSomebodyBrakesNoHarderForAvoidance) {
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 11, 0, -1, "WC_1");
  const double line = here_.path(driver).links.at(0).stop_line;
  here_.move(driver, line - 2.25 - 17);
  const std::size_t walker = here_.add("pedestrian", {"CW", "WC"}, 0, 1.3, 5, 195);
  here_.set_speed(walker, 0.5);
  here_.move(walker, here_.path(walker).links.at(0).stop_line + 10);
  here_.update();
  ASSERT_EQ(here_.context(driver).foe, here_.scene.id[walker].value);
  EXPECT_NEAR(here_.context(driver).to_halt, 17 - TrafficParameters{}.stop_margin, 0.1);
  auto chosen = [&](std::size_t row) {
    Workspace work;
    return gamma_velocity(here_.model, here_.scene, here_.geometry, row, here_.scene.behavior[row],
                          work);
  };
  EXPECT_NEAR(chosen(driver).norm(), here_.context(driver).allowed_speed, 0.01);
  // not counted on, its halt would be too late
  here_.scene.context[driver].to_halt = 1e9;
  EXPECT_LT(chosen(driver).norm(), here_.context(driver).allowed_speed - 0.3);
}

// a lorry drove on towards a van in its way, because it was too late to halt before the place where
// their ways cross, and met it nose to nose
TEST_F(PriorityTest, NobodyDrivesOnTowardsWhoIsInTheWay) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 0, 6, 0, -1, "WC_0");
  const std::size_t foe = here_.add("truck", {"SC", "CN"}, 0, 0);
  here_.move(own, zone_of(own, foe) - 2.25 - 1.5);
  here_.move(foe, zone_of(foe, own) + 2.0);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(own).foe, static_cast<std::int64_t>(here_.scene.id[foe].value));
  EXPECT_LT(here_.context(own).allowed_speed, 5.8) << "it brakes hard";
}

}  // namespace
}  // namespace sumogamma
