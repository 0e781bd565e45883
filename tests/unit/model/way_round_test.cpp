#include "model/way_round.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "model/gamma_velocity.h"
#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;

/// A car that comes to the crossroads from the south and means to turn right.
class WayRoundTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("priority"));
    return network;
  }

  void SetUp() override {
    own_ = here_.add("car", {"SC", "CE"}, 0, 0);
    here_.move(own_, here_.path(own_).links.front().stop_line + 2.0);
  }

  /// Somebody who stands with its centre so far ahead and to the left of the car [m], turned left
  /// against it [rad].
  std::size_t stands(const std::string& type, double ahead, double left, double turned) {
    const std::size_t row = here_.add(type, {"SC", "CN"}, 0, 0);
    const Vec2 forward = direction_of(here_.scene.heading[own_]);
    here_.scene.position[row] = here_.scene.position[own_] + from_body(Vec2(ahead, left), forward);
    here_.scene.heading[row] = here_.scene.heading[own_] + turned;
    return row;
  }

  std::optional<double> way(double wish) {
    Workers workers;
    prepare_tick(here_.model, here_.scene, workers, here_.geometry);
    RoadContext& context = here_.scene.context[own_];
    context.active = true;
    context.tangent = direction_of(here_.scene.heading[own_] + turned_);
    return way_round(here_.model, here_.scene, here_.geometry, own_,
                     5.0 * direction_of(here_.scene.heading[own_] + wish));
  }

  RoadScene here_{net()};
  std::size_t own_ = 0;
  double turned_ = 0;  ///< its way against its heading [rad]
};

constexpr double kRight = -0.6;  // [rad]

TEST_F(WayRoundTest, OnAFreeRoadItIsTheOneThatWasMeant) {
  for (const double wish : {kRight, 0.0, 0.6}) EXPECT_FALSE(way(wish)) << wish;
}

// a van pressed against the tail of a bus that stood to the right of its nose, and needed 50 s to
// turn right behind it, over a junction on which there was nobody else
TEST_F(WayRoundTest, WhoTurnsRightBehindATailGoesStraightOnUntilItIsPast) {
  stands("bus", -2.0, -2.35, 0.0);  // its front 4 m ahead of the car's middle
  const auto turn = way(kRight);
  ASSERT_TRUE(turn);
  EXPECT_GE(*turn, 0.0);
  EXPECT_FALSE(way(0.0)) << "straight on is free";
}

// a bicycle that found no way past a car at red rode back, against its own traffic
TEST(TurnsBack, WhoPointsAcrossItsWayAndTurnsFurtherFromIt) {
  const Vec2 way(1, 0);
  for (const double side : {1.0, -1.0}) {
    const Vec2 across(0, side);
    EXPECT_TRUE(turns_back(across, way, side * 0.3));
    EXPECT_TRUE(turns_back(across, way, 0.0));
    EXPECT_FALSE(turns_back(across, way, -side * 0.3)) << "it turns to its way";
    EXPECT_FALSE(turns_back(-across, way, side * 0.3)) << "likewise";
    EXPECT_FALSE(turns_back(Vec2(1, side), way, side * 0.3)) << "it gets on as it turns";
  }
}

TEST_F(WayRoundTest, NobodyRidesBackForIt) {
  stands("bus", -2.0, -2.35, 0.0);
  ASSERT_TRUE(way(kRight));
  turned_ = -1.5;
  EXPECT_FALSE(way(kRight)) << "straight on and to the left would be back";
}

TEST_F(WayRoundTest, ThereIsNoneThroughAWall) {
  stands("bus", 2.25 + 1.25 + 0.3, 0.0, 0.5 * kPi);
  for (const double wish : {kRight, 0.0, 0.6}) EXPECT_FALSE(way(wish)) << wish;
}

TEST_F(WayRoundTest, NorBeyondTheBoundaryOfItsRoom) {
  stands("bus", 5.5, -6.5, 0.5 * kPi);  // what is right of the middle ahead
  here_.scene.context[own_].room_left = 5.0;
  const auto turn = way(0.0);
  ASSERT_TRUE(turn);
  EXPECT_GT(*turn, 0.0);
  here_.scene.context[own_].room_left = 0.0;
  EXPECT_FALSE(way(0.0));
}

TEST_F(WayRoundTest, WhoMovesIsLeftToAvoidance) {
  const std::size_t bus = stands("bus", -2.0, -2.35, 0.0);
  ASSERT_TRUE(way(kRight));
  here_.set_speed(bus, 1.0);
  EXPECT_FALSE(way(kRight));
}

// wedged beside a queue, a van crept past it over the sidewalk for 33 s
TEST_F(WayRoundTest, WhoIsWedgedLeavesItsLaneByLessThanAMetre) {
  stands("bus", 2.25 + 1.25 + 0.3, 0.0, 0.5 * kPi);
  const auto creeps_right = [&](double beyond) {
    here_.update();
    RoadContext& context = here_.scene.context[own_];
    context.allowed_speed = 1.0;
    context.sub_goal = here_.scene.position[own_] + Vec2(0.0, 8.0);
    context.room_left = 5.0;
    context.room_right = -beyond;
    here_.scene.held[own_].wedge_left = 5.0;
    Workspace work;
    const Vec2 chosen = gamma_velocity(here_.model, here_.scene, here_.geometry, own_,
                                       here_.scene.behavior[own_], work);
    return cross(direction_of(here_.scene.heading[own_]), chosen) < -0.01;
  };
  EXPECT_TRUE(creeps_right(0.0));
  EXPECT_TRUE(creeps_right(0.6));
  EXPECT_FALSE(creeps_right(1.0));
}

// its wheels pointed to the right, so that its tail would have swung into the van beside it: it
// stood for 6 s of the green and held a whole queue
TEST_F(WayRoundTest, WhoseTailWouldSwingTurnsItsWheelsStraightBeforeItRollsOff) {
  const double beside = 1.8 + 0.012;  // two cars with hardly a gap between them
  stands("car", -3.5, beside, 0.0);
  here_.scene.steering[own_] = -0.5;
  const Vec2 from = here_.scene.position[own_];
  Workspace work;
  for (int k = 0; k < 60; ++k) {
    here_.update();
    RoadContext& context = here_.scene.context[own_];
    context.allowed_speed = std::max(context.allowed_speed, 0.6);
    context.sub_goal = here_.scene.position[own_] + Vec2(1.0, 8.0);
    const Vec2 asked = gamma_velocity(here_.model, here_.scene, here_.geometry, own_,
                                      here_.scene.behavior[own_], work);
    place_body(track_velocity(here_.model, here_.scene, own_, asked, 0.05), here_.scene, own_);
  }
  EXPECT_GT((here_.scene.position[own_] - from).norm(), 0.5);
}

}  // namespace
}  // namespace sumogamma
