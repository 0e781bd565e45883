#include "traffic/junction/waiting_place.h"

#include <gtest/gtest.h>

#include "support/junction_scenes.h"
#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::PriorityTest;
using testing::RoadScene;

// a left turn waits for oncoming traffic on the junction, but not where others are about to cross
TEST_F(PriorityTest, WhoWaitsOnTheJunctionLeavesTheWaysOfOthersFree) {
  const std::size_t own = here_.add("car", {"WC", "CN"}, 0, 2);
  here_.move(own, here_.path(own).links.front().stop_line + 0.5 - 2.25);
  const std::size_t oncoming = here_.add("car", {"EC", "CW"}, 0, 12);
  here_.move(oncoming, here_.path(oncoming).links.front().stop_line - 15);
  here_.update();
  ASSERT_EQ(here_.context(own).reason, LimitReason::Yield);
  const double alone = here_.context(own).to_halt;
  const std::size_t crossing = here_.add("bus", {"NC", "CS"}, 0, 6);
  here_.move(crossing, here_.path(crossing).links.front().stop_line - 12);
  here_.update();
  ASSERT_EQ(here_.context(own).foe, here_.scene.id[oncoming].value);
  EXPECT_LT(here_.context(own).to_halt, alone - 1.0);
  // not for ever
  here_.traffic.waiting_time[own] = 30.0;
  here_.update();
  EXPECT_EQ(here_.context(own).to_halt, alone);
}

// a bus came to rest half a metre beyond its place, took itself for being past it, where who comes
// first goes first, and turned before those who came towards it
TEST_F(PriorityTest, WhoRollsOutBeyondItsPlaceOnTheJunctionStillWaitsThere) {
  const std::size_t own = here_.add("car", {"WC", "CN"}, 0, 0);
  const std::size_t oncoming = here_.add("car", {"EC", "CW"}, 0, 10);
  const PathLink& link = here_.path(own).links.front();
  here_.move(oncoming, here_.path(oncoming).links.front().stop_line - 15);
  const double place = std::min(link.inside, zone_of(own, oncoming)) - 0.3;
  ASSERT_GT(place, link.stop_line + 1.5) << "there is a place to wait on the junction";
  for (const double beyond : {0.0, 0.25, 0.5}) {
    here_.move(own, place + beyond - 2.25);
    here_.update();
    EXPECT_EQ(here_.context(own).reason, LimitReason::Yield) << beyond;
  }
}

// a motorcycle that had come along beside a queue waited on a junction in the way of a truck that
// turned there
TEST_F(PriorityTest, WhoRidesBesideTheMiddleOfItsLaneWaitsForLongBodiesBeforeTheJunction) {
  for (const std::string oncoming_type : {"car", "bus"}) {
    RoadScene here{net()};
    const std::size_t own = here.add("motorcycle", {"WC", "CN"}, 0, 3);
    const std::size_t oncoming = here.add(oncoming_type, {"EC", "CW"}, 0, 10);
    here.move(oncoming, here.path(oncoming).links.front().stop_line - 15);
    for (const double aside : {-1.0, 0.0, 1.0}) {
      here.move(own, here.path(own).links.front().stop_line - 6, aside);
      here.traffic.passing_offset[own] = aside;
      here.update();
      ASSERT_EQ(here.context(own).foe, here.scene.id[oncoming].value) << aside;
      const bool on_junction = here.context(own).to_halt > 6.0;
      EXPECT_EQ(on_junction, oncoming_type == "car" || aside == 0.0) << oncoming_type << aside;
    }
  }
}

// a bus that had rolled beyond its place amid a junction set out before a lorry at 10 m/s, since it
// was the first to get into its way; they met nose to nose, and 47 stood behind them
TEST_F(PriorityTest, WhoHasToWaitBeyondItsPlaceOnTheJunctionCutsNobodyOff) {
  const std::size_t own = here_.add("car", {"WC", "CN"}, 0, 0);
  const std::size_t oncoming = here_.add("car", {"EC", "CW"}, 0, 0);
  here_.move(own, zone_of(own, oncoming) - 0.35 - 2.25);
  ASSERT_GT(zone_of(own, oncoming) - 0.35, here_.path(own).links.front().inside + 0.3)
      << "past its place";
  here_.move(oncoming, zone_of(oncoming, own) - 20 - 2.25);
  for (const double speed : {4.0, 12.0}) {
    here_.set_speed(oncoming, speed);
    here_.update();
    EXPECT_EQ(here_.context(own).reason == LimitReason::Yield, speed > 10) << speed;
  }
}

}  // namespace
}  // namespace sumogamma
