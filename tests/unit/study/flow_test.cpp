#include <gtest/gtest.h>

#include "study/flow_metrics.h"
#include "support/plain_net.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

constexpr double kStep = 0.1;

class Flow : public ::testing::Test {
 protected:
  Flow() { road_.signal_states = {"Gr"}; }

  std::size_t add(const char* type, const Vec2& position, const char* lane = nullptr,
                  double along = 0) {
    AgentState agent;
    agent.id = AgentId{next_++};
    agent.type = find_agent_type(types_, type);
    agent.footprint = box_footprint(4, 2);
    agent.position = position;
    append_agent(scene_, agent);
    if (lane) scene_.lane.back() = {net_.lane_by_name.at(lane), along, 0};
    return scene_.size() - 1;
  }
  void run(double seconds) {
    for (int tick = 0; tick < static_cast<int>(seconds / kStep + 0.5); ++tick) {
      scene_.time += kStep;
      for (std::size_t row = 0; row < scene_.size(); ++row)
        scene_.position[row] += kStep * scene_.velocity[row];
      monitor_.add(scene_, types_, road_, WaitGraph(scene_));
    }
  }

  RoadNetwork net_ = testing::small_net();
  AgentTypeTable types_ = default_agent_types();
  RoadState road_;
  Scene scene_;
  FlowMonitor monitor_{kStep, net_};
  std::uint32_t next_ = 0;
};

TEST_F(Flow, SpeedAndDistance) {
  const std::size_t row = add("car", {0, 0});
  scene_.velocity[row] = {10, 0};
  add("pedestrian", {0, 5});
  run(20);
  const FlowResult result = monitor_.result(types_);
  EXPECT_NEAR(result.mean_speed, 5.0, 1e-9);
  EXPECT_NEAR(result.mean_speed_by_type.at("car"), 10.0, 1e-9);
  EXPECT_NEAR(result.distance_km, 0.199, 1e-9);  // the first tick has no predecessor
  EXPECT_NEAR(result.waiting_time_mean_s, 0, 1e-9);
}

TEST_F(Flow, WaitingTimeIsPerVehicle) {
  add("car", {0, 0});
  const std::size_t row = add("car", {50, 0});
  scene_.velocity[row] = {5, 0};
  add("pedestrian", {0, 5});
  run(10);
  EXPECT_NEAR(monitor_.result(types_).waiting_time_mean_s, 5.0, 1e-6);
}

TEST_F(Flow, StuckAfterAMinute) {
  add("car", {50, 0}, "out_0", 30);
  run(59);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 0u);
  run(2);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 1u);
  ASSERT_EQ(monitor_.stuck().size(), 1u);
  EXPECT_NEAR(monitor_.stuck()[0].since, 0, 1e-6);
  EXPECT_EQ(monitor_.stuck()[0].lane, net_.lane_by_name.at("out_0"));
  EXPECT_FALSE(monitor_.stuck()[0].moved_on);
  EXPECT_EQ(monitor_.stuck_now(), 1u);
  scene_.velocity[0] = {3, 0};
  run(1);
  EXPECT_TRUE(monitor_.stuck()[0].moved_on);
  EXPECT_EQ(monitor_.stuck_now(), 0u);
  scene_.velocity[0] = {0, 0};
  run(70);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 1u) << "an agent is counted once";
  EXPECT_EQ(monitor_.stuck().size(), 2u) << "each standstill is listed";
}

// people went to and fro before walls for minutes, and nobody counted them
TEST_F(Flow, WhoShufflesToAndFroGetsNowhere) {
  const std::size_t row = add("pedestrian", {0, 0});
  run(1);
  for (int k = 0; k < 62; ++k) {
    scene_.velocity[row] = {k % 2 ? 0.5 : -0.5, 0};
    run(1);
  }
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 1u);
  scene_.velocity[row] = {0.5, 0};
  run(3);
  EXPECT_EQ(monitor_.stuck_now(), 0u);
}

TEST_F(Flow, ARedLightSuspendsTheCountButDoesNotResetIt) {
  add("car", {50, 0}, "in_1", 50);
  road_.signal_states = {"rr"};
  run(300);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 0u);
  EXPECT_EQ(monitor_.result(types_).longest_standstill_s, 0);
  for (int cycle = 0; cycle < 3; ++cycle) {
    road_.signal_states = {"Gr"};
    run(25);
    road_.signal_states = {"rr"};
    run(30);
  }
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 1u) << "75 s of green without moving";
}

TEST_F(Flow, StuckAgentsKnowTheHeadOfTheirQueue) {
  for (int k = 0; k < 3; ++k) {
    const std::size_t row = add("car", {50.0 + 8 * k, 0}, "out_0", 30.0 + 8 * k);
    scene_.context[row].active = true;
    scene_.context[row].reason = LimitReason::Leader;
    scene_.context[row].foe = k + 1;
  }
  scene_.context[2].reason = LimitReason::Merge;
  scene_.context[2].foe = -1;
  run(61);
  ASSERT_EQ(monitor_.stuck().size(), 3u);
  EXPECT_EQ(monitor_.stuck()[0].head, 2);
  EXPECT_EQ(monitor_.stuck()[0].head_reason, LimitReason::Merge);
  EXPECT_EQ(monitor_.stuck()[2].head, -1) << "it waits for nobody";
  EXPECT_FALSE(monitor_.stuck()[0].ring);
}

// a bus stood on the way that leaves a junction to the right behind cars that waited there for a
// light straight on
TEST_F(Flow, WhoWaitsForSomebodyAtARedLightIsNotStuck) {
  const std::size_t behind = add("bus", {0, 0}), middle = add("car", {10, 0}),
                    head = add("car", {20, 0});
  for (const std::size_t row : {behind, middle, head}) scene_.context[row].active = true;
  scene_.context[behind].reason = scene_.context[middle].reason = LimitReason::Leader;
  scene_.context[behind].foe = scene_.id[middle].value;
  scene_.context[middle].foe = scene_.id[head].value;
  scene_.context[head].reason = LimitReason::Signal;
  run(70);
  EXPECT_TRUE(monitor_.stuck().empty());
  scene_.context[head].reason = LimitReason::None;
  run(70);
  EXPECT_EQ(monitor_.stuck().size(), 3u);
}

TEST_F(Flow, WhoWaitForOneAnotherAreARing) {
  for (int k = 0; k < 3; ++k) {
    const std::size_t row = add("car", {50.0 + 8 * k, 0}, "out_0", 30.0 + 8 * k);
    scene_.context[row].active = true;
    scene_.context[row].reason = LimitReason::Yield;
    scene_.context[row].foe = k < 2 ? k + 1 : 1;
  }
  run(61);
  ASSERT_EQ(monitor_.stuck().size(), 3u);
  EXPECT_TRUE(monitor_.stuck()[0].ring) << "behind a ring, too";
  EXPECT_EQ(monitor_.stuck()[0].head, -1);
  EXPECT_TRUE(monitor_.stuck()[2].ring);
}

TEST_F(Flow, PlannedHaltsAndSignalsOfTheModelExcuse) {
  const std::size_t row = add("bus", {50, 0}, "out_0", 30);
  scene_.context[row].active = true;
  scene_.context[row].reason = LimitReason::Stop;
  run(120);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 0u);
  scene_.context[row].reason = LimitReason::Leader;
  scene_.context[row].foe = 7;
  run(61);
  ASSERT_EQ(monitor_.stuck().size(), 1u);
  EXPECT_EQ(monitor_.stuck()[0].reason, LimitReason::Leader);
  EXPECT_EQ(monitor_.stuck()[0].foe, 7);
}

TEST_F(Flow, PedestriansWaitWhereAllTheirCrossingsAreRed) {
  add("pedestrian", {99, 3}, ":C_w0_0", 0);
  road_.signal_states = {"Gr"};
  run(100);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 0u);
  road_.signal_states = {"rG"};
  run(61);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 1u);
}

// two stood nose to nose over every red light for 270 s, rocked by 10 cm, and were never stuck
TEST_F(Flow, WhoGetsNoFurtherIsHeldWhateverTheReason) {
  const std::size_t row = add("truck", {50, 0}, "in_1", 50);
  for (int k = 0; k < 98; ++k) {
    road_.signal_states = {k / 30 % 2 ? "Gr" : "rr"};
    scene_.velocity[row] = {k % 2 ? 1.5 : -1.5, 0};
    run(1);
  }
  EXPECT_EQ(monitor_.result(types_).held_agents, 0u);
  scene_.velocity[row] = {0, 0};
  run(4);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 0u);
  EXPECT_EQ(monitor_.result(types_).held_agents, 1u);
  ASSERT_EQ(monitor_.held().size(), 1u);
  EXPECT_NEAR(monitor_.held()[0].since, kStep, 1e-6);
  EXPECT_FALSE(monitor_.held()[0].moved_on);
  scene_.velocity[row] = {5, 0};
  run(1);
  EXPECT_TRUE(monitor_.held()[0].moved_on);
  scene_.velocity[row] = {0, 0};
  run(110);
  EXPECT_EQ(monitor_.result(types_).held_agents, 1u) << "an agent is counted once";
  EXPECT_EQ(monitor_.held().size(), 2u) << "each stay is listed";
}

TEST_F(Flow, WhoCreepsOnOrHaltsAsPlannedIsNotHeld) {
  scene_.velocity[add("car", {0, 0})] = {0.05, 0};
  const std::size_t bus = add("bus", {50, 0}, "out_0", 30);
  scene_.context[bus].active = true;
  scene_.context[bus].reason = LimitReason::Stop;
  run(300);
  EXPECT_EQ(monitor_.result(types_).held_agents, 0u);
  EXPECT_NEAR(monitor_.result(types_).longest_held_s, 80, 0.5);
}

TEST_F(Flow, LeavingAgentsAreForgotten) {
  add("car", {50, 0}, "out_0", 30);
  run(50);
  remove_agents(scene_, {true});
  add("car", {50, 0}, "out_0", 30);
  run(50);
  EXPECT_EQ(monitor_.result(types_).stuck_agents, 0u);
}

TEST(RedLights, LookThroughUnsignalledLanes) {
  // in -> C shows red; a lane before it would see it, the lane behind the junction doesn't
  const RoadNetwork net = testing::small_net();
  RedLights lights(net);
  RoadState road;
  road.signal_states = {"rr"};
  lights.update(road, {});
  EXPECT_TRUE(lights.ahead(net.lane_by_name.at("in_1")));
  EXPECT_FALSE(lights.ahead(net.lane_by_name.at(":C_0_0")));
  EXPECT_FALSE(lights.ahead(net.lane_by_name.at("back_in_0")));
  EXPECT_FALSE(lights.ahead(kNoLane));
  road.signal_states = {"Gr"};
  lights.update(road, {});
  EXPECT_FALSE(lights.ahead(net.lane_by_name.at("in_1")));
}

// queues of 300 m reached back over a junction, and their tails were stuck by the first red
TEST(RedLights, AreWaitedForByAllOfAQueue) {
  testing::PlainNet plain;
  plain.nodes = R"(<node id="A" x="0" y="0"/><node id="B" x="150" y="0"/>
    <node id="C" x="400" y="0" type="traffic_light"/><node id="D" x="550" y="0"/>
    <node id="S" x="400" y="-150"/><node id="T" x="150" y="-150"/>)";
  for (const std::string way : {"AB", "BC", "CD", "SC", "TB"})
    plain.edges += "<edge id=\"" + way + "\" from=\"" + way[0] + "\" to=\"" + way[1] +
                   "\" numLanes=\"1\" speed=\"13\"/>";
  const RoadNetwork net = testing::read_plain_net(plain);
  RedLights lights(net);
  RoadState road;
  road.signal_states = {"rrrr"};
  Scene scene;
  AgentState last;
  last.footprint = box_footprint(4, 2);
  append_agent(scene, last);
  const auto ahead = [&](double along, double speed) {
    scene.lane[0] = {net.lane_by_name.at("BC_0"), along, 0};
    scene.velocity[0] = {speed, 0};
    lights.update(road, scene);
    return lights.ahead(net.lane_by_name.at("AB_0"));
  };
  EXPECT_TRUE(ahead(12, 0));
  EXPECT_FALSE(ahead(12, 8)) << "it drives";
  EXPECT_FALSE(ahead(60, 0)) << "there is room behind it";
  road.signal_states = {"GGGG"};
  EXPECT_FALSE(ahead(12, 0)) << "it waits for something else";
}

}  // namespace
}  // namespace sumogamma
