#include "outputs/lane_passages.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

/// W --100 m--> C --100 m--> E, two lanes each, joined over a junction.
class LanePassagesTest : public ::testing::Test {
 protected:
  LanePassagesTest()
      : network_(testing::read_plain_net(
            {R"(<node id="W" x="-100" y="0"/><node id="C" x="0" y="0"/><node id="E" x="100"
 y="0"/><node id="N" x="0" y="100"/><node id="S" x="0" y="-100"/>)",
             R"(<edge id="WC" from="W" to="C" numLanes="2" speed="14"/><edge id="CE" from="C"
 to="E" numLanes="2" speed="14"/><edge id="NC" from="N" to="C" speed="14"/><edge id="CS" from="C"
 to="S" speed="14"/>)",
             "",
             {}})),
        motion_(network_, 1.0) {
    car_.name = "car";
    car_.length = 5;
    car_.max_speed = 20;
  }
  VehiclePlace at(const char* lane, double front, double speed) const {
    VehiclePlace place;
    place.lane = network_.lane_by_name.at(lane);
    place.front = front;
    place.speed = speed;
    place.speed_limit = 14;
    return place;
  }
  void step(const VehiclePlace& place) {
    motion_.begin_step(time_);
    motion_.move(car_, place);
    time_ += 1.0;
  }
  std::size_t count(LaneEntry entry, LaneExit exit) const {
    std::size_t number = 0;
    for (const LanePassage& one : motion_.passages())
      number += (one.entry == entry && one.entry != LaneEntry::None) ||
                (one.exit == exit && one.exit != LaneExit::None);
    return number;
  }

  RoadNetwork network_;
  LanePassages motion_;
  OutputVehicle car_;
  double time_ = 0;
};

TEST_F(LanePassagesTest, AVehicleDepartsAndDrivesOn) {
  step(at("WC_0", 20, 10));
  EXPECT_EQ(count(LaneEntry::Departed, LaneExit::None), 1u);
  EXPECT_DOUBLE_EQ(motion_.odometer(0).distance, 10.0);
  step(at("WC_0", 30, 10));
  ASSERT_EQ(motion_.passages().size(), 1u);
  const LanePassage& one = motion_.passages()[0];
  EXPECT_DOUBLE_EQ(one.from, 20.0);
  EXPECT_DOUBLE_EQ(one.to, 30.0);
  EXPECT_DOUBLE_EQ(one.passing_time(25.0), 0.5);
  EXPECT_DOUBLE_EQ(one.passing_time(20.0, 5.0), 0.5);
  EXPECT_NEAR(motion_.odometer(0).time_loss, 2.0 * 4.0 / 14.0, 1e-9);
}

TEST_F(LanePassagesTest, ItsTailStaysBehindOnTheLaneThatItsFrontLeaves) {
  const double end = network_.lane(network_.lane_by_name.at("WC_0")).length;
  step(at("WC_0", end - 2, 10));
  step(at("CE_0", 1, 12));
  bool on_old = false, on_new = false, inside = false;
  for (const LanePassage& one : motion_.passages()) {
    const Lane& lane = network_.lane(one.lane);
    if (lane.name == "WC_0") {
      on_old = true;
      EXPECT_EQ(one.exit, LaneExit::Junction);
      EXPECT_NEAR(one.from, end - 2, 1e-9);
      EXPECT_GT(one.to, end);
    }
    if (lane.kind == LaneKind::Internal) {
      inside = true;
      EXPECT_EQ(one.entry, LaneEntry::Junction);
      EXPECT_EQ(one.exit, LaneExit::Junction);
    }
    if (lane.name == "CE_0") {
      on_new = true;
      EXPECT_EQ(one.entry, LaneEntry::Junction);
      EXPECT_LT(one.from, 0.0);
      EXPECT_NEAR(one.to, 1.0, 1e-9);
    }
  }
  EXPECT_TRUE(on_old && inside && on_new);
  // long past them no lane behind is touched
  step(at("CE_0", 40, 14));
  EXPECT_LE(motion_.passages().size(), 3u);
  step(at("CE_0", 50, 10));
  EXPECT_EQ(motion_.passages().size(), 1u);
}

TEST_F(LanePassagesTest, LaneChangesAreToldOfBothLanes) {
  step(at("WC_0", 20, 10));
  step(at("WC_1", 30, 10));
  ASSERT_EQ(motion_.passages().size(), 3u);
  EXPECT_EQ(motion_.passages()[1].exit, LaneExit::LaneChange);
  EXPECT_EQ(motion_.passages()[2].entry, LaneEntry::LaneChange);
  EXPECT_DOUBLE_EQ(motion_.odometer(0).distance, 20.0);
}

// else it would trip a loop twice
TEST_F(LanePassagesTest, WhoBacksUpStandsUntilItIsPastWhereItWas) {
  step(at("WC_0", 30, 10));
  step(at("WC_0", 28, 0));
  EXPECT_DOUBLE_EQ(motion_.passages()[0].to, 30.0);
  step(at("WC_0", 31, 3));
  EXPECT_DOUBLE_EQ(motion_.passages()[0].from, 30.0);
  EXPECT_DOUBLE_EQ(motion_.passages()[0].to, 31.0);
  EXPECT_EQ(motion_.odometer(0).waiting_count, 1);
}

TEST_F(LanePassagesTest, WhoArrivesGoesOnForAStep) {
  step(at("CE_0", 50, 10));
  motion_.begin_step(time_);
  motion_.end(car_, 0, true);
  EXPECT_EQ(count(LaneEntry::None, LaneExit::Arrived), 1u);
  EXPECT_DOUBLE_EQ(motion_.last_place(0).front, 60.0);
}

TEST_F(LanePassagesTest, ParkingIsAStopOffTheLanes) {
  step(at("WC_0", 30, 0));
  VehiclePlace parked;
  parked.stopped = true;
  for (int i = 0; i < 3; ++i) step(parked);
  EXPECT_TRUE(motion_.passages().empty());
  EXPECT_DOUBLE_EQ(motion_.odometer(0).stop_time, 3.0);
  step(at("WC_0", 32, 2));
  EXPECT_EQ(count(LaneEntry::Placed, LaneExit::None), 1u);
  EXPECT_EQ(count(LaneEntry::Departed, LaneExit::None), 0u);
}

TEST_F(LanePassagesTest, AJumpIsNoDrive) {
  step(at("WC_0", 30, 10));
  step(at("NC_0", 30, 10));
  EXPECT_EQ(count(LaneEntry::Placed, LaneExit::Taken), 2u);
}

}  // namespace
}  // namespace sumogamma
