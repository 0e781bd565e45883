#include <gtest/gtest.h>

#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;
using testing::route_of;

/// Somebody at the kerb of the west arm, which has two lanes each way, half way along it: WC's
/// lanes are crossed first.
class JaywalkingTest : public ::testing::Test {
 protected:
  JaywalkingTest() {
    const std::vector<EdgeId> route = route_of(here_.model.road, {"WC", "CW"});
    PathRequest request;
    request.route = route;
    request.vehicle_class = vehicle_class::kPedestrian;
    request.start_along = 20;
    request.arrival_position = 5;
    request.max_speed = 1.3;
    request.mid_block = 0.5;
    std::string why;
    auto path = build_walking_path(here_.model.road, request, why);
    if (!path) throw std::runtime_error(why);
    walker_ = here_.add(find_agent_type(here_.model.types, "pedestrian"),
                        std::make_shared<const Path>(std::move(*path)), 0, 0);
    over_ = here_.path(walker_).over_road.at(0);
    wait_at_kerb();
  }
  void wait_at_kerb() { here_.move(walker_, over_.begin - 0.5); }
  double kerb_x() const { return here_.path(walker_).line.point_at(over_.begin).x(); }
  /// A car on WC whose front is so far before the way over the road [m].
  std::size_t add_car(double gap, double speed, const std::string& lane = "WC_1") {
    const std::size_t car = here_.add("car", {"WC", "CE"}, 0, speed, 0, -1, lane);
    here_.move(car, kerb_x() + 200 - gap - 2.25);
    return car;
  }
  /// One on CW, whose lanes are crossed last.
  std::size_t add_car_beyond(double gap, double speed) {
    const std::size_t car = here_.add("car", {"EC", "CW"}, 0, speed, 0, -1, "EC_1");
    const double place = here_.path(car).line.project(Vec2(kerb_x(), 3.2)).along;
    here_.move(car, place - gap - 2.25);
    return car;
  }
  bool waits_for(std::size_t foe) {
    here_.update();
    const RoadContext& context = here_.context(walker_);
    return context.reason == LimitReason::Crossing && context.foe == here_.scene.id[foe].value &&
           context.allowed_speed < 0.6;
  }
  bool goes() {
    here_.update();
    return here_.context(walker_).reason == LimitReason::None &&
           here_.context(walker_).allowed_speed > 1.0;
  }
  static const RoadNetwork& net() {
    static const RoadNetwork network =
        read_plain_net(crossroads("priority", {"--sidewalks.guess", "--crossings.guess"}));
    return network;
  }
  RoadScene here_{net()};
  std::size_t walker_ = 0;
  RoadCrossing over_;
};

TEST_F(JaywalkingTest, GoesWhenNobodyComes) { EXPECT_TRUE(goes()); }

TEST_F(JaywalkingTest, WaitsForWhoComesAndGoesOnceItHasPassed) {
  const std::size_t car = add_car(40, 12);
  EXPECT_TRUE(waits_for(car));
  here_.move(car, here_.scene.path_along[car] + 46);
  EXPECT_TRUE(goes());
}

TEST_F(JaywalkingTest, WaitsForWhoComesOnTheFarSide) {
  // a dozen metres away across the road: that takes nine seconds
  EXPECT_TRUE(waits_for(add_car_beyond(100, 12)));
}

TEST_F(JaywalkingTest, GoesBeforeWhoIsFarAndBehindWhoIsGoneFirst) {
  add_car(120, 10);
  add_car_beyond(12, 12);
  EXPECT_TRUE(goes());
}

TEST_F(JaywalkingTest, GoesBetweenThoseWhoStand) {
  add_car(1.5, 0);
  add_car(-4.5 - 1.5, 0);
  EXPECT_TRUE(goes());
}

TEST_F(JaywalkingTest, WaitsForABodyThatStandsInTheWayButNotForEver) {
  const std::size_t car = add_car(-2, 0);
  EXPECT_TRUE(waits_for(car));
  here_.traffic.waiting_time[walker_] = 61;
  EXPECT_TRUE(goes());
}

TEST_F(JaywalkingTest, WhoHasWaitedForLongGoesWhereNobodyBrakesHard) {
  const std::size_t car = add_car(35, 12);
  here_.traffic.waiting_time[walker_] = 61;
  EXPECT_TRUE(waits_for(car));
  here_.move(car, here_.scene.path_along[car] - 20);
  EXPECT_TRUE(goes());
}

// with the first step the patience was gone, and the walker halted again, over and over
TEST_F(JaywalkingTest, WhoHasSetOutKeepsToIt) {
  const std::size_t car = add_car(55, 12);
  EXPECT_TRUE(waits_for(car));
  here_.traffic.waiting_time[walker_] = 61;
  EXPECT_TRUE(goes());
  here_.traffic.waiting_time[walker_] = 0;
  EXPECT_TRUE(goes());
}

TEST_F(JaywalkingTest, WhoIsOnTheRoadGoesOnAndIsWaitedFor) {
  const std::size_t car = add_car(15, 8);
  here_.move(walker_, over_.begin + 2.0);
  EXPECT_TRUE(goes());
  EXPECT_EQ(here_.context(car).reason, LimitReason::Leader);
  EXPECT_EQ(here_.context(car).foe, here_.scene.id[walker_].value);
  EXPECT_LT(here_.context(car).allowed_speed, 8.0);
}

}  // namespace
}  // namespace sumogamma
