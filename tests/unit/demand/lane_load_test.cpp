#include "demand/lane_load.h"

#include <gtest/gtest.h>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

constexpr double kHour = 3600.0;

/// The crossroads of support/plain_net.h with flows over it.
class LaneLoad : public ::testing::Test {
 protected:
  explicit LaneLoad(const std::string& type = "priority",
                    const std::vector<std::string>& options = {})
      : road_(testing::read_plain_net(testing::crossroads(type, options))),
        flow_(road_.connections.size()) {}

  /// vehicles/h from a lane to an edge
  void drive(const std::string& lane, const std::string& edge, double vehicles) {
    for (std::size_t i = 0; i < road_.connections.size(); ++i) {
      const Connection& way = road_.connections[i];
      if (road_.lane(way.from).name != lane || road_.edge(road_.lane(way.to).edge).name != edge)
        continue;
      flow_[i] = vehicles / kHour;
      return;
    }
    FAIL() << "no way from " << lane << " to " << edge;
  }
  double load(const std::string& lane) const {
    return lane_loads(road_, flow_)[index_of(road_.lane_by_name.at(lane))];
  }

  RoadNetwork road_;
  std::vector<double> flow_;
};

TEST_F(LaneLoad, WhoHasTheRightOfWayGoesAtSaturationFlow) {
  drive("WC_1", "CE", 950);
  EXPECT_NEAR(load("WC_1"), 0.5, 0.001);
  EXPECT_EQ(load("WC_0"), 0.0);
  EXPECT_EQ(load("SC_0"), 0.0);
}

// Harders at 700 vehicles/h: 0.1944 exp(-0.1944 * 5.5) / (1 - exp(-0.1944 * 3)) = 0.1509/s = 543/h
TEST_F(LaneLoad, WhoGivesWayGetsTheGaps) {
  drive("WC_0", "CE", 700);
  drive("SC_0", "CE", 543);
  EXPECT_NEAR(load("SC_0"), 1.0, 0.005);
}

TEST_F(LaneLoad, AFullRoadLetsOneAMinuteIn) {
  drive("WC_0", "CE", 5000);
  drive("WC_1", "CE", 5000);
  drive("SC_0", "CN", 60);
  EXPECT_NEAR(load("SC_0"), 1.0, 0.001);
}

TEST_F(LaneLoad, WaysOutOfOneLaneAddUp) {
  drive("WC_0", "CE", 380);
  drive("WC_0", "CS", 380);
  EXPECT_NEAR(load("WC_0"), 0.4, 0.001);
}

class SignalledLaneLoad : public LaneLoad {
 protected:
  SignalledLaneLoad() : LaneLoad("traffic_light", {"--tls.default-type", "static"}) {}
};

TEST_F(SignalledLaneLoad, ASignalGivesItsShareOfGreen) {
  ASSERT_EQ(road_.signals.size(), 1u);
  double cycle = 0, green = 0;
  const auto way = std::find_if(road_.connections.begin(), road_.connections.end(),
                                [&](const Connection& connection) {
                                  return road_.lane(connection.from).name == "WC_0" &&
                                         connection.direction == TurnDirection::Straight;
                                });
  ASSERT_NE(way, road_.connections.end());
  for (const SignalPhase& phase : road_.signals[0].phases) {
    cycle += phase.duration;
    if (phase.state.at(static_cast<std::size_t>(way->signal_link)) == 'G') green += phase.duration;
  }
  ASSERT_GT(green, 20);
  ASSERT_LT(green, 60);
  drive("WC_0", "CE", 1900 * green / cycle);
  EXPECT_NEAR(load("WC_0"), 1.0, 0.001);
}

// left turns wait for those who come towards them, in the same green
TEST_F(SignalledLaneLoad, ATurnInTheSameGreenGetsTheGaps) {
  drive("WC_1", "CN", 100);
  const double alone = load("WC_1");
  drive("EC_0", "CW", 500);
  EXPECT_GT(load("WC_1"), 2 * alone);
}

}  // namespace
}  // namespace sumogamma
