#include "traffic/junction/long_wait.h"

#include <gtest/gtest.h>

#include "support/junction_scenes.h"

namespace sumogamma {
namespace {

using testing::CrossingTest;
using testing::PriorityTest;

// where they come one after the other, left turns waited for a gap for 90 s
class LongStand : public PriorityTest {
 protected:
  /// Over the major road, before which it has stood for so long [s].
  void stand(double time) {
    here_.traffic.halted_for[own_] = here_.path(own_).links.front().connection;
    here_.traffic.halted_at[own_] = here_.scene.time - time;
    here_.scene.context[own_].reason = LimitReason::Yield;
  }
  /// Somebody on the major road comes, so far before its line.
  void come(double way, double speed = 12) {
    here_.set_speed(driver_, speed);
    here_.move(driver_, here_.path(driver_).links.front().stop_line - 2.25 - way);
  }
  bool waits(std::size_t row, std::size_t foe) const {
    return here_.context(row).foe == here_.scene.id[foe].value;
  }
  std::size_t own_ = add_at_line({"SC", "CN"});
  std::size_t driver_ = here_.add("car", {"WC", "CE"}, 0, 12, 0, -1, "WC_0");
};

TEST_F(LongStand, NosesOutBeforeWhoHaltsForItAtEase) {
  for (const double way : {40.0, 25.0}) {
    for (const double time : {40.0, 60.0}) {
      come(way);
      stand(time);
      here_.update();
      const bool goes = way == 40.0 && time == 60.0;
      EXPECT_NE(waits(own_, driver_), goes) << way << " m, " << time << " s";
      EXPECT_EQ(waits(driver_, own_), goes) << way << " m, " << time << " s";
    }
  }
}

TEST_F(LongStand, NobodyWaitsForItForLongNorWhoHasStoodForAsLong) {
  come(0.5, 0);
  stand(60);
  here_.update();
  EXPECT_TRUE(waits(driver_, own_));
  here_.traffic.waiting_time[driver_] = 15;
  here_.update();
  EXPECT_FALSE(waits(driver_, own_)) << "it has waited for it long enough";
  here_.traffic.waiting_time[driver_] = 0;
  here_.traffic.halted_for[driver_] = here_.path(driver_).links.front().connection;
  here_.traffic.halted_at[driver_] = here_.scene.time - 60;
  here_.update();
  EXPECT_FALSE(waits(driver_, own_)) << "of two that nose out one would wait for the other";
}

// it halted on the junction before each lane for somebody who stood there for it
TEST_F(LongStand, GoesBeforeWhoStandsAndWaitsForIt) {
  come(0.5, 0);
  stand(60);
  here_.traffic.waiting_time[driver_] = 5;
  here_.scene.context[driver_].reason = LimitReason::Yield;
  here_.scene.context[driver_].foe = static_cast<std::int64_t>(here_.scene.id[own_].value);
  here_.update();
  EXPECT_FALSE(waits(own_, driver_));
  EXPECT_TRUE(waits(driver_, own_));
}

TEST_F(LongStand, CountsOnTheJunctionToo) {
  const std::size_t turning = here_.add("car", {"WC", "CN"}, 0, 0);
  const PathLink link = here_.path(turning).links.front();
  here_.scene.held[turning].standing = 1.0;
  here_.move(turning, link.inside - 1.0 - 2.25);
  here_.update();
  EXPECT_EQ(here_.traffic.halted_for[turning], link.connection);
}

// where vehicles go first and come without end, somebody on foot stood at the kerb for minutes
TEST_F(CrossingTest, WhoHasWaitedForLongStepsOutBeforeWhoHaltsForItAtEase) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0, 195, 5);
  here_.move(walker, here_.path(walker).links.at(0).stop_line - 0.3);
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 12, 0, -1, "WC_1");
  const double line = here_.path(driver).links.at(0).stop_line;
  const auto waits = [&](double waited, double way) {
    here_.move(driver, line - 2.25 - way);
    here_.traffic.waiting_time[walker] = waited;
    here_.update();
    return here_.context(walker).foe == here_.scene.id[driver].value;
  };
  EXPECT_TRUE(waits(20, 48));
  EXPECT_FALSE(waits(40, 48)) << "four seconds away, it halts with 1.5 m/s^2";
  EXPECT_TRUE(waits(40, 28)) << "it would have to brake harder";
  // where they come one after the other somebody always comes within three seconds
  here_.set_speed(driver, 5.0);
  EXPECT_TRUE(waits(20, 10));
  EXPECT_FALSE(waits(40, 10));
  here_.set_speed(driver, 0.8);
  EXPECT_FALSE(waits(40, 1.5));
  EXPECT_TRUE(waits(40, -0.4)) << "it is on the crossing already";
}

// somebody set out and stepped back for 92 s, since its wait began anew each time
TEST_F(CrossingTest, WhoStepsBackHasWaitedSinceItCame) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0, 195, 5);
  const PathLink& link = here_.path(walker).links.at(0);
  here_.move(walker, link.stop_line - 0.3);
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 12, 0, -1, "WC_1");
  here_.move(driver, here_.path(driver).links.at(0).stop_line - 2.25 - 48);
  const auto waits = [&](double came) {
    here_.traffic.halted_for[walker] = kNoConnection;
    here_.scene.time = came;
    here_.scene.held[walker].standing = 1.0;
    here_.update();
    here_.scene.time = 100;
    here_.scene.held[walker].standing = 0.0;
    here_.update();
    return here_.context(walker).foe == here_.scene.id[driver].value;
  };
  EXPECT_TRUE(waits(70));
  EXPECT_FALSE(waits(50));
}

// it forgot that it had waited with its first step, and turned round; a queue that crept over the
// crossing left no place to step onto
TEST_F(CrossingTest, WhoHasSetOutGoesOnAndDriversHaltForIt) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0, 195, 5);
  here_.move(walker, here_.path(walker).links.at(0).stop_line - 0.3);
  const std::size_t driver = here_.add("car", {"WC", "CE"}, 0, 1.5, 0, -1, "WC_1");
  const double line = here_.path(driver).links.at(0).stop_line;
  here_.move(driver, line - 2.25 - 3.0);
  const auto waited = [&](double time, double speed) {
    here_.traffic.waiting_time[walker] = time;
    here_.set_speed(walker, speed);
    here_.scene.context[walker].reason = LimitReason::Yield;
    here_.update();
    const bool walker_waits = here_.context(walker).foe == here_.scene.id[driver].value;
    const bool driver_halts = here_.context(driver).foe == here_.scene.id[walker].value;
    EXPECT_NE(walker_waits, driver_halts) << time << " s, " << speed << " m/s";
    return walker_waits;
  };
  EXPECT_TRUE(waited(20, 0));
  EXPECT_FALSE(waited(35, 0));
  EXPECT_FALSE(waited(20, 0.8));
  EXPECT_TRUE(waited(5, 0.8));
  here_.traffic.waiting_time[driver] = 15;
  here_.traffic.waiting_time[walker] = 35;
  here_.update();
  EXPECT_NE(here_.context(driver).foe, here_.scene.id[walker].value) << "it has waited long enough";
}

}  // namespace
}  // namespace sumogamma
