#include "study/traffic_measures.h"

#include <gtest/gtest.h>

#include "support/small_net.h"

namespace sumogamma {
namespace {

constexpr double kCoarseStep = 0.5;

class Traffic : public ::testing::Test {
 protected:
  void add(const char* type, const char* lane, double speed) {
    AgentState agent;
    agent.id = AgentId{next_++};
    agent.type = find_agent_type(types_, type);
    agent.speed = speed;
    append_agent(scene_, agent);
    scene_.velocity.back() = {speed, 0};
    for (std::size_t i = 0; i < network_.lanes.size(); ++i)
      if (network_.lanes[i].name == lane) scene_.lane.back().lane = static_cast<LaneId>(i);
    ASSERT_NE(scene_.lane.back().lane, kNoLane);
  }
  void run(TrafficMonitor& monitor, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      scene_.time = ++tick_ * kCoarseStep;
      monitor.add(scene_, types_);
    }
  }

  RoadNetwork network_ = testing::small_net();
  AgentTypeTable types_ = default_agent_types();
  Scene scene_;
  std::uint32_t next_ = 0;
  int tick_ = 0;
};

TEST(Edie, FlowIsDensityTimesSpeed) {
  // 3 agents at 5 m/s for 20 s on 100 m
  const EdieFigures figures = edie_figures({60, 300, 0, 0}, 100, 350, 20);
  EXPECT_DOUBLE_EQ(figures.speed, 5.0);
  EXPECT_DOUBLE_EQ(figures.density, 0.03);
  EXPECT_DOUBLE_EQ(figures.flow, 0.15);
  EXPECT_DOUBLE_EQ(figures.flow, figures.density * figures.speed);
  EXPECT_DOUBLE_EQ(figures.area_density, 3.0 / 350.0);
  EXPECT_EQ(edie_figures({}, 100, 0, 20).speed, 0.0);
}

// two cars and a bus on one lane of 95 m, 13.9 m/s allowed, for 10 s
TEST_F(Traffic, SumsByLaneAndType) {
  add("car", "in_1", 13.9);
  add("car", "in_1", 0.0);
  add("bus", "in_1", 6.95);
  TrafficMonitor monitor(kCoarseStep, network_, 60.0);
  run(monitor, 20);
  const auto lanes = monitor.lanes();
  ASSERT_EQ(lanes.size(), 2u);
  EXPECT_EQ(lanes[0].begin, 0.0);
  EXPECT_EQ(lanes[0].end, 10.0);
  EXPECT_EQ(type_of(types_, lanes[0].type).name, "car");
  EXPECT_NEAR(lanes[0].presence.time, 20.0, 1e-9);
  EXPECT_NEAR(lanes[0].presence.distance, 139.0, 1e-9);
  EXPECT_NEAR(lanes[0].presence.waiting, 10.0, 1e-9);
  EXPECT_NEAR(lanes[0].presence.delay, 10.0, 1e-9);
  EXPECT_NEAR(lanes[1].presence.delay, 5.0, 1e-9);
  const TrafficResult result = monitor.result(types_);
  EXPECT_NEAR(result.delay_mean, 5.0, 1e-9);
  EXPECT_NEAR(result.mode_share.at("car"), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(result.distance_share.at("bus"), 69.5 / 208.5, 1e-12);
}

TEST_F(Traffic, CutsTimeIntoIntervals) {
  add("car", "in_1", 10);
  add("pedestrian", "in_0", 1.0);
  TrafficMonitor monitor(kCoarseStep, network_, 4.0);
  run(monitor, 12);
  remove_agents(scene_, {true, false});
  run(monitor, 8);
  const auto types = monitor.types();
  double time = 0;
  std::uint64_t entered = 0, left = 0;
  for (const TypeInterval& one : types) {
    EXPECT_LE(one.end - one.begin, 4.0 + 1e-9);
    time += one.presence.time;
    entered += one.entered;
    left += one.left;
  }
  EXPECT_NEAR(time, 6.0 + 10.0, 1e-9);
  EXPECT_EQ(entered, 2u);
  EXPECT_EQ(left, 1u);
  EXPECT_EQ(types.back().end, 10.0);
  const auto journeys = monitor.journeys();
  ASSERT_EQ(journeys.size(), 2u);
  EXPECT_EQ(journeys[0].left, 6.0);
  EXPECT_NEAR(journeys[0].presence.distance, 60.0, 1e-9);
  EXPECT_EQ(journeys[1].left, -1.0);
}

TEST_F(Traffic, AHaltThatIsPlannedIsNoDelay) {
  add("bus", "in_1", 0.0);
  scene_.halt[0].left = 5.0;
  TrafficMonitor monitor(kCoarseStep, network_, 60.0);
  run(monitor, 4);
  EXPECT_EQ(monitor.journeys().front().presence.delay, 0.0);
  EXPECT_EQ(monitor.journeys().front().presence.waiting, 0.0);
}

}  // namespace
}  // namespace sumogamma
