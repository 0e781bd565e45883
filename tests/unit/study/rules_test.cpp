#include <gtest/gtest.h>

#include "base/units.h"
#include "study/rule_metrics.h"
#include "support/plain_net.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

constexpr double kRuleStep = 0.1;

class Rules : public ::testing::Test {
 protected:
  Rules() { road_.signal_states = {"Gr"}; }

  void add(const char* type, const Vec2& position, const Vec2& velocity) {
    AgentState agent;
    agent.id = AgentId{next_++};
    agent.type = find_agent_type(types_, type);
    agent.footprint =
        box_footprint(type_of(types_, agent.type).length, type_of(types_, agent.type).width);
    agent.position = position;
    agent.heading = heading_of(velocity);
    agent.speed = velocity.norm();
    append_agent(scene_, agent);
  }
  void run(double seconds) {
    for (int tick = 0; tick < static_cast<int>(seconds / kRuleStep + 0.5); ++tick) {
      scene_.time += kRuleStep;
      for (std::size_t row = 0; row < scene_.size(); ++row)
        scene_.position[row] += kRuleStep * scene_.velocity[row];
      monitor_.add(scene_, types_, road_, workers_);
      events_ += monitor_.new_events().size();
    }
  }
  RuleCounts counts() const { return monitor_.result(types_).all; }

  RoadNetwork net_ = testing::small_net();
  LaneLocator locator_{net_};
  AgentTypeTable types_ = default_agent_types();
  RoadState road_;
  Scene scene_;
  Workers workers_;
  RuleMonitor monitor_{kRuleStep, net_, locator_};
  std::uint32_t next_ = 0;
  std::size_t events_ = 0;
};

TEST_F(Rules, PassingGreenIsNoOffence) {
  add("car", {70, 0}, {10, 0});
  run(5);
  EXPECT_EQ(counts().red_light_crossings, 0u);
  EXPECT_EQ(counts().signal_crossings, 1u);
}

TEST_F(Rules, PassingRedIsOneOffence) {
  road_.signal_states = {"rr"};
  add("car", {70, 0}, {10, 0});
  run(5);
  EXPECT_EQ(counts().red_light_crossings, 1u);
  EXPECT_EQ(monitor_.result(types_).by_type.at("car").red_light_crossings, 1u);
  EXPECT_EQ(events_, 1u);
}

TEST_F(Rules, WhoIsOnAnotherWayOnlyDrivesOverTheLine) {
  road_.signal_states = {"rr"};
  add("car", {70, 0}, {10, 0});
  add("car", {55, 0}, {10, 0});
  scene_.lane[0].lane = net_.lane_by_name.at("back_0");
  scene_.lane[1].lane = net_.lane_by_name.at("in_1");
  run(5);
  EXPECT_EQ(counts().red_light_crossings, 1u);
}

// offences of all kinds, in an order that only the rows may decide
TEST_F(Rules, AnyNumberOfWorkersFindsTheSame) {
  road_.signal_states = {"rr"};
  for (int k = 0; k < 5; ++k) {
    add("car", {60.0 - 8 * k, 0}, {10, 0});
    add("car", {80.0 + 3 * k, 0}, {-5, 0});
    add("pedestrian", {101, 3.5 + k}, {0, -1.3});
    add("truck", {20.0 + 5 * k, 30}, {0, 1});
    add("motorcycle", {20.0 + 5 * k, 2.6}, {1, 0});
  }
  const Scene start = scene_;
  run(6);
  EXPECT_GT(counts().red_light_crossings, 5u);
  EXPECT_GT(counts().red_lights_met, 5u);
  EXPECT_GT(counts().off_road_s, 5.0);
  EXPECT_GT(counts().wrong_way_s, 5.0);
  EXPECT_GT(counts().sidewalk_by_vehicle_s, 5.0);
  Workers three(3);
  RuleMonitor monitor(kRuleStep, net_, locator_);
  scene_ = start;
  for (int tick = 0; tick < 60; ++tick) {
    scene_.time += kRuleStep;
    for (std::size_t row = 0; row < scene_.size(); ++row)
      scene_.position[row] += kRuleStep * scene_.velocity[row];
    monitor.add(scene_, types_, road_, three);
  }
  ASSERT_EQ(monitor.offences().size(), monitor_.offences().size());
  for (std::size_t i = 0; i < monitor.offences().size(); ++i) {
    const OffenceSpan &one = monitor_.offences()[i], &other = monitor.offences()[i];
    EXPECT_EQ(one.id, other.id);
    EXPECT_EQ(one.kind, other.kind);
    EXPECT_EQ(one.since, other.since);
    EXPECT_EQ(one.duration, other.duration);
  }
  EXPECT_EQ(monitor.result(types_).all.red_lights_met, counts().red_lights_met);
}

TEST_F(Rules, AmberIsNoOffence) {
  road_.signal_states = {"yr"};
  add("car", {70, 0}, {10, 0});
  run(5);
  EXPECT_EQ(counts().red_light_crossings, 0u);
}

// A motorcycle between two lanes, of which one has red and the other green, and a car amid the one
// with red.
TEST(RulesBetweenLanes, WhoDrivesBetweenTwoLanesGoesByTheLightOfEither) {
  const RoadNetwork net = testing::read_plain_net(testing::crossroads("traffic_light"));
  const LaneLocator locator(net);
  const AgentTypeTable types = default_agent_types();
  RoadState road;
  road.signal_states.assign(net.signals.size(), std::string(32, 'G'));
  const Edge& edge = net.edge(net.edge_by_name.at("WC"));
  const Lane& outer = net.lane(edge.lanes[0]);
  for (const ConnectionId id : outer.outgoing) {
    const Connection& connection = net.connection(id);
    road.signal_states[index_of(connection.signal)]
                      [static_cast<std::size_t>(connection.signal_link)] = 'r';
  }
  const auto red_lights = [&](const char* type, double offset) {
    Workers workers;
    RuleMonitor monitor(kRuleStep, net, locator);
    AgentState agent;
    agent.type = find_agent_type(types, type);
    const AgentType& row = type_of(types, agent.type);
    agent.footprint = box_footprint(row.length, row.width);
    const double length = outer.centerline.length();
    agent.position = outer.centerline.point_at(length - 15) +
                     offset * left_of(outer.centerline.direction_at(length));
    agent.speed = 10;
    Scene scene;
    append_agent(scene, agent);
    for (int tick = 0; tick < 40; ++tick) {
      scene.time += kRuleStep;
      scene.position[0] += kRuleStep * scene.velocity[0];
      monitor.add(scene, types, road, workers);
    }
    return monitor.result(types).all.red_light_crossings;
  };
  EXPECT_EQ(red_lights("car", 0.0), 1u);
  EXPECT_EQ(red_lights("motorcycle", 0.0), 1u);
  EXPECT_EQ(red_lights("motorcycle", 0.5 * outer.width - 0.1), 0u);
}

// The lane beside ends 2 m earlier: the stop line runs askew from one lane's end to the other's,
// and who halts before it at the edge of the shorter lane is beyond that lane's end, yet before the
// line.
TEST(RulesBetweenLanes, TheStopLineRunsThroughTheEndsOfLanesSideBySide) {
  RoadNetwork net = testing::read_plain_net(testing::crossroads("traffic_light"));
  const Edge& edge = net.edge(net.edge_by_name.at("WC"));
  Lane& inner = net.lanes[index_of(edge.lanes[1])];
  const Vec2 begin = inner.centerline.points().front();
  const double end = inner.centerline.length() - 2.0;
  inner.centerline = Polyline({begin, inner.centerline.point_at(end)});
  const LaneLocator locator(net);
  const AgentTypeTable types = default_agent_types();
  RoadState road;
  road.signal_states.assign(net.signals.size(), std::string(32, 'r'));
  const auto red_lights = [&](double offset, double past) {
    Workers workers;
    RuleMonitor monitor(kRuleStep, net, locator);
    AgentState agent;
    agent.type = find_agent_type(types, "car");
    const AgentType& car = type_of(types, agent.type);
    agent.footprint = box_footprint(car.length, car.width);
    const Vec2 forward = inner.centerline.direction_at(end);
    const Vec2 halt = inner.centerline.point_at(end) - offset * left_of(forward) + past * forward;
    Scene scene;
    append_agent(scene, agent);
    for (int tick = 0; tick < 40; ++tick) {
      const double left = std::max(8.0 - 4.0 * scene.time, 0.0);
      scene.time += kRuleStep;
      scene.position[0] = halt - (0.5 * car.length + left) * forward;
      monitor.add(scene, types, road, workers);
    }
    return monitor.result(types).all.red_light_crossings;
  };
  const double at_edge = 0.5 * inner.width - 0.2;
  EXPECT_EQ(red_lights(at_edge, 0.5), 0u);
  EXPECT_EQ(red_lights(at_edge, 1.2), 1u);
  EXPECT_EQ(red_lights(0.0, 0.5), 1u);
}

TEST_F(Rules, StoppingBeforeTheLineIsNoOffence) {
  road_.signal_states = {"rr"};
  add("car", {92.0, 0}, {0, 0});
  run(5);
  EXPECT_EQ(counts().signal_crossings, 0u);
}

TEST_F(Rules, TheUnsignalledDirectionIsFree) {
  road_.signal_states = {"rr"};
  add("car", {130, -3.2}, {-10, 0});
  run(5);
  EXPECT_EQ(counts().signal_crossings, 0u);
}

TEST_F(Rules, ALightThatTurnsRedWithinTheStepIsNobodysFault) {
  add("car", {70, 0}, {10, 0});
  // the front (2.25 m ahead) stands at 94.25 after 2.2 s and at 95.25 after 2.3 s
  run(2.2);
  road_.signal_states = {"rr"};
  run(3);
  EXPECT_EQ(counts().signal_crossings, 1u);
  EXPECT_EQ(counts().red_light_crossings, 0u);
}

TEST_F(Rules, CrossingTheBridgeIsNotRunningTheRed) {
  road_.signal_states = {"rr"};
  add("car", {50, -30}, {0, 10});
  run(6);
  EXPECT_EQ(counts().signal_crossings, 0u);
  EXPECT_EQ(counts().wrong_way_s, 0);
  EXPECT_EQ(counts().off_road_s, 0);
}

TEST_F(Rules, ARedLightIsMetByWhoCouldGo) {
  road_.signal_states = {"rr"};
  add("car", {90, 0}, {0.1, 0});
  add("car", {84, 0}, {0.1, 0});        // behind it: front within reach, but held
  add("bicycle", {88, 1.4}, {0.1, 0});  // beside it: nobody in front
  add("car", {84, -3.2}, {0.1, 0});     // on the other side of the road
  run(3);
  const RuleResult result = monitor_.result(types_);
  EXPECT_EQ(result.all.red_lights_met, 2u);
  EXPECT_EQ(result.by_type.at("car").red_lights_met, 1u);
  EXPECT_EQ(result.all.red_light_crossings, 0u);
  // the first one goes at red: met once, and the next one is at the line then
  scene_.speed[0] = 5;
  scene_.velocity[0] = Vec2(5, 0);
  run(3);
  EXPECT_EQ(monitor_.result(types_).by_type.at("car").red_lights_met, 2u);
  EXPECT_EQ(counts().red_light_crossings, 1u);
}

TEST_F(Rules, WhoGoesThroughAtSpeedHasMetTheRedLight) {
  road_.signal_states = {"rr"};
  add("car", {70, 0}, {10, 0});
  run(5);
  EXPECT_EQ(counts().red_light_crossings, 1u);
  EXPECT_EQ(counts().red_lights_met, 1u);
}

TEST_F(Rules, AGreenLightIsNoRedLightMet) {
  add("car", {90, 0}, {0.5, 0});
  run(5);
  EXPECT_EQ(counts().red_lights_met, 0u);
}

TEST_F(Rules, SomebodyOnFootHasMetARedLightWhoWaitedForIt) {
  road_.signal_states = {"Gr"};
  add("pedestrian", {101, 2.6}, {0, -1e-3});
  run(2);
  EXPECT_EQ(counts().red_lights_met, 0u);  // it may stand there for another reason
  road_.signal_states = {"rG"};
  scene_.velocity[0] = Vec2(0, -1.3);
  run(3);
  EXPECT_EQ(counts().red_lights_met, 1u);
  EXPECT_EQ(counts().red_light_crossings, 0u);
}

TEST_F(Rules, PedestrianOnRedAndOnGreen) {
  add("pedestrian", {101, 3.5}, {0, -1.3});
  run(8);
  EXPECT_EQ(counts().red_light_crossings, 1u);
  EXPECT_EQ(counts().signal_crossings, 1u);
  road_.signal_states = {"rG"};
  add("pedestrian", {101, 3.5}, {0, -1.3});
  run(8);
  EXPECT_EQ(counts().red_light_crossings, 1u);
  EXPECT_EQ(counts().signal_crossings, 2u);
}

TEST_F(Rules, WhoSteppedOnAtGreenHasNotCrossedAtRed) {
  road_.signal_states = {"rG"};
  add("pedestrian", {101, 2.6}, {0, -1.3});
  run(0.6);  // 0.2 m deep
  road_.signal_states = {"rr"};
  run(4);
  EXPECT_EQ(counts().signal_crossings, 1u);
  EXPECT_EQ(counts().red_light_crossings, 0u);
}

TEST_F(Rules, WhoIsPressedOffACrossingAndComesBackIsStillOnIt) {
  road_.signal_states = {"rG"};
  add("pedestrian", {101, 2.6}, {0, -1.3});
  run(3);
  road_.signal_states = {"rr"};
  for (const double sideways : {1.0, -1.0}) {
    scene_.velocity[0] = Vec2(sideways, 0);
    run(3);
  }
  EXPECT_EQ(counts().signal_crossings, 1u);
  EXPECT_EQ(counts().red_light_crossings, 0u);
  // who has reached the kerb and steps on again has not
  for (const double across : {1.3, -1.3}) {
    scene_.velocity[0] = Vec2(0, across);
    run(4);
  }
  EXPECT_EQ(counts().red_light_crossings, 1u);
}

TEST_F(Rules, WhoGoesRoundAVanThatStandsOverACrossingIsStillOnIt) {
  road_.signal_states = {"rG"};
  add("pedestrian", {101, 2.6}, {0, -1.3});
  scene_.lane[0].lane = net_.lane_by_name.at(":C_c0_0");
  run(3);
  road_.signal_states = {"rr"};
  for (const double sideways : {1.0, 0.0, -1.0}) {
    scene_.velocity[0] = Vec2(sideways, 0);
    run(sideways == 0.0 ? 12 : 3);
  }
  EXPECT_EQ(counts().red_light_crossings, 0u);
}

// a van stood at the begin of a crossing: who set out at green went round it, and came onto the
// crossing when that was red
TEST_F(Rules, WhoGoesRoundAVanFromTheKerbOnHasSetOutWhenItLeftThat) {
  for (const bool at_green : {true, false}) {
    scene_ = Scene{};
    add("pedestrian", {104, 2.6}, {0, -1.3});
    scene_.lane[0].lane = net_.lane_by_name.at(":C_c0_0");
    road_.signal_states = {at_green ? "rG" : "rr"};
    run(1);
    road_.signal_states = {"rr"};
    run(1);
    scene_.velocity[0] = Vec2(-1, 0);
    run(3);
    EXPECT_EQ(counts().red_light_crossings, at_green ? 0u : 1u);
  }
}

TEST_F(Rules, PedestrianGrazingTheCornerOfACrossing) {
  add("pedestrian", {98, 1.8}, {1.3, 0});
  run(4);
  EXPECT_EQ(counts().signal_crossings, 0u);
}

TEST_F(Rules, WhoKeepsToASidewalkThatLiesOverTheEndOfACrossingIsNotOnIt) {
  add("pedestrian", {98, 1.2}, {1.3, 0});
  scene_.lane[0] = {net_.lane_by_name.at("in_0"), 95, -1.4};
  run(4);
  EXPECT_EQ(counts().signal_crossings, 0u);
  scene_.position[0] = Vec2(98, 1.2);
  scene_.lane[0].offset = -2.0;  // no longer on it
  run(4);
  EXPECT_EQ(counts().red_light_crossings, 1u);
}

TEST_F(Rules, WrongWayNeedsALaneAgainstAndNoneWith) {
  add("car", {80, 0}, {-5, 0});
  run(2);
  EXPECT_NEAR(counts().wrong_way_s, 2.0, 1e-9);
  ASSERT_EQ(monitor_.offences().size(), 1u);
  EXPECT_EQ(monitor_.offences()[0].kind, Offence::WrongWay);
  EXPECT_NEAR(monitor_.offences()[0].duration, 2.0, 1e-9);
  scene_ = Scene{};
  add("car", {80, -3.2}, {-5, 0});
  run(2);
  EXPECT_NEAR(counts().wrong_way_s, 2.0, 1e-9) << "its own lane";
}

TEST_F(Rules, OvertakingOverTheMiddleIsNoOffence) {
  // what a car does for a second on the lane that leads the other way, the other one ahead of it on
  // the lane beside
  auto counted = [&](const char* other, const Vec2& velocity, double speed = 5.0,
                     double ahead = 8.0) {
    RuleMonitor monitor(kRuleStep, net_, locator_);
    scene_ = Scene{};
    add("car", {80, 0}, {-speed, 0});
    add(other, {80 - ahead, -3.2}, velocity);
    for (int tick = 0; tick < 10; ++tick) monitor.add(scene_, types_, road_, workers_);
    return monitor.result(types_).all;
  };
  EXPECT_NEAR(counted("bicycle", {-4, 0}).wrong_way_s, 1.0, 1e-9) << "the network doesn't let it";
  const LaneId against = net_.lane_by_name.at("in_1"), own = net_.lane_by_name.at("back_0");
  net_.lanes[index_of(against)].opposite = own;
  EXPECT_NEAR(counted("bicycle", {-4, 0}).overtaking_s, 1.0, 1e-9);
  EXPECT_EQ(counted("bicycle", {-4, 0}).wrong_way_s, 0.0);
  // between one bicycle and the next, 30 m ahead: at 14 m/s it stays out, at 6 m/s it has the time
  EXPECT_EQ(counted("bicycle", {-4, 0}, 14.0, 30.0).wrong_way_s, 0.0);
  EXPECT_NEAR(counted("bicycle", {-4, 0}, 6.0, 30.0).wrong_way_s, 1.0, 1e-9);
  EXPECT_NEAR(counted("car", {-4, 0}).wrong_way_s, 1.0, 1e-9) << "past a queue of cars";
  EXPECT_NEAR(counted("bicycle", {4, 0}).wrong_way_s, 2.0, 1e-9) << "against its lane, too";
  EXPECT_NEAR(counted("bicycle", {-7, 0}).wrong_way_s, 1.0, 1e-9) << "it is faster";
}

TEST_F(Rules, CrossingALaneSidewaysIsNotWrongWay) {
  add("car", {20, -6}, {0, 5});
  run(2);
  EXPECT_EQ(counts().wrong_way_s, 0);
  EXPECT_GT(counts().off_road_s, 0);
}

TEST_F(Rules, CreepingBackIsNotWrongWay) {
  add("car", {80, 0}, {-0.4, 0});
  run(2);
  EXPECT_EQ(counts().wrong_way_s, 0);
}

TEST_F(Rules, BackingUpIsNotWrongWay) {
  add("car", {80, 0}, {-1, 0});
  scene_.heading[0] = 0;
  run(2);
  EXPECT_EQ(counts().wrong_way_s, 0);
}

TEST_F(Rules, OffRoadAndSidewalk) {
  add("car", {20, 30}, {0, 0});
  run(1);
  EXPECT_NEAR(counts().off_road_s, 1.0, 1e-9);
  add("car", {20, 2.6}, {0, 0});
  add("bicycle", {40, 2.6}, {0, 0});
  add("pedestrian", {60, 2.6}, {0, 0});
  run(1);
  EXPECT_NEAR(counts().off_road_s, 2.0, 1e-9);
  EXPECT_NEAR(counts().sidewalk_by_vehicle_s, 1.0, 1e-9)
      << "the car alone: a bicycle is no motor vehicle";
  EXPECT_NEAR(monitor_.result(types_).by_type.at("car").sidewalk_by_vehicle_s, 1.0, 1e-9);
}

// A published network has lanes 3.2 m wide whose middles are 3.3 m apart: who changed lanes was off
// the road for a moment.
TEST(RulesInGaps, TheStripBetweenLanesIsRoad) {
  RoadNetwork net = testing::small_net();
  for (const char* name : {"back_0", ":C_1_0", "back_in_0"}) {
    Lane& lane = net.lanes[index_of(net.lane_by_name.at(name))];
    std::vector<Vec2> aside;
    for (const Vec2& point : lane.centerline.points()) aside.push_back(point - Vec2(0, 0.3));
    lane.centerline = Polyline(aside);
  }
  // two lanes end short of the junction
  for (const char* name : {"in_1", "back_0"}) {
    Lane& lane = net.lanes[index_of(net.lane_by_name.at(name))];
    std::vector<Vec2> shorter = lane.centerline.points();
    (name[0] == 'i' ? shorter.back() : shorter.front()).x() -= 0.4;
    lane.centerline = Polyline(shorter);
  }
  const LaneLocator locator(net);
  const AgentTypeTable types = default_agent_types();
  const auto off_road = [&](const Vec2& position, double heading) {
    Workers workers;
    RuleMonitor monitor(kRuleStep, net, locator);
    Scene scene;
    AgentState agent;
    agent.type = find_agent_type(types, "car");
    agent.footprint = box_footprint(4, 2);
    agent.position = position;
    agent.heading = heading;
    append_agent(scene, agent);
    for (int tick = 0; tick < 10; ++tick) monitor.add(scene, types, {}, workers);
    return monitor.result(types).all.off_road_s;
  };
  for (const double heading : {0.0, 0.4, 1.2}) {
    EXPECT_EQ(off_road({20, -1.75}, heading), 0) << "between both directions";
    EXPECT_EQ(off_road({94.75, 0}, heading), 0) << "between a lane and the junction";
    EXPECT_NEAR(off_road({20, -5.6}, heading), 1.0, 1e-9) << "beyond the outer edge";
    EXPECT_NEAR(off_road({150, 1.8}, heading), 1.0, 1e-9) << "likewise, where no sidewalk is";
  }
}

// lanes end askew where they meet on a junction: somebody was on a splinter of a sidewalk for a
// tick
TEST_F(Rules, NobodyIsOverAnEdgeByCentimetres) {
  const auto seconds = [&](double y, double speed) {
    RuleMonitor monitor(kRuleStep, net_, locator_);
    scene_ = Scene{};
    add("car", {80, y}, {-speed, 0});
    for (int tick = 0; tick < 10; ++tick) monitor.add(scene_, types_, road_, workers_);
    const RuleCounts counted = monitor.result(types_).all;
    return counted.wrong_way_s + counted.sidewalk_by_vehicle_s;
  };
  EXPECT_EQ(seconds(-1.55, 5), 0.0);
  EXPECT_NEAR(seconds(-1.45, 5), 1.0, 1e-9);
  EXPECT_EQ(seconds(1.65, 0), 0.0);
  EXPECT_NEAR(seconds(1.75, 0), 1.0, 1e-9);
}

TEST_F(Rules, ACarOnACrossingIsOnTheRoad) {
  add("car", {101, 0}, {0, 0});
  run(1);
  EXPECT_EQ(counts().sidewalk_by_vehicle_s, 0);
  EXPECT_EQ(counts().off_road_s, 0);
}

TEST_F(Rules, ThePathOfAFootwayOverAJunctionIsNoSidewalk) {
  Lane& over_junction = net_.lanes[static_cast<std::size_t>(net_.lane_by_name.at(":C_0_0"))];
  over_junction.allowed = vehicle_class::kPedestrian | vehicle_class::kBicycle;
  add("car", {97, 0}, {0, 0});
  run(1);
  EXPECT_EQ(counts().sidewalk_by_vehicle_s, 0);
}

TEST_F(Rules, ATeleportPassesNothing) {
  road_.signal_states = {"rr"};
  add("car", {90, 0}, {0, 0});
  run(0.2);
  scene_.position[0] = {150, 0};
  run(0.2);
  EXPECT_EQ(counts().signal_crossings, 0u);
}

// T junction: one lane, right turn green, straight on red. Judged by where the car goes.
constexpr const char* kFork = R"xml(<net version="1.9">
  <edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="9" length="10" shape="50,0 60,0"/></edge>
  <edge id=":J_1" function="internal"><lane id=":J_1_0" index="0" speed="9" length="10" shape="50,0 55,-2 55,-10"/></edge>
  <edge id="a" from="A" to="J"><lane id="a_0" index="0" speed="9" length="50" shape="0,0 50,0"/></edge>
  <edge id="b" from="J" to="B"><lane id="b_0" index="0" speed="9" length="50" shape="60,0 110,0"/></edge>
  <edge id="c" from="J" to="D"><lane id="c_0" index="0" speed="9" length="50" shape="55,-10 55,-60"/></edge>
  <junction id="A" type="dead_end" x="0" y="0" incLanes="" intLanes="" shape="0,0 0,1"/>
  <junction id="B" type="dead_end" x="110" y="0" incLanes="b_0" intLanes="" shape="0,0 0,1"/>
  <junction id="D" type="dead_end" x="55" y="-60" incLanes="c_0" intLanes="" shape="0,0 0,1"/>
  <junction id="J" type="traffic_light" x="55" y="0" incLanes="a_0" intLanes=":J_0_0 :J_1_0" shape="50,2 60,2 60,-10 50,-10">
    <request index="0" response="00" foes="00" cont="0"/><request index="1" response="00" foes="00" cont="0"/>
  </junction>
  <connection from="a" to="b" fromLane="0" toLane="0" via=":J_0_0" tl="J" linkIndex="0" dir="s" state="o"/>
  <connection from="a" to="c" fromLane="0" toLane="0" via=":J_1_0" tl="J" linkIndex="1" dir="r" state="o"/>
</net>)xml";

TEST_F(Rules, ARoadCrossedBetweenJunctionsCountsOnceAtItsFarSide) {
  auto path = std::make_shared<Path>();
  path->line = Polyline({Vec2(70, -20), Vec2(70, 20)});
  path->over_road = {{15, 25}};
  road_.paths = {path};
  add("pedestrian", {70, -20}, {0, 1.3});
  scene_.path[0] = static_cast<PathId>(0);
  auto walk = [&](double seconds) {
    for (double time = 0; time < seconds; time += kRuleStep) {
      run(kRuleStep);
      scene_.path_along[0] = scene_.position[0].y() + 20;
    }
  };
  walk(18);
  EXPECT_EQ(counts().mid_block_crossings, 0u);
  walk(10);
  EXPECT_EQ(counts().mid_block_crossings, 1u);
  EXPECT_EQ(monitor_.result(types_).by_type.at("pedestrian").mid_block_crossings, 1u);
}

class Fork : public ::testing::TestWithParam<bool> {};

TEST_P(Fork, MixedLightsAreJudgedByTheTurnTaken) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("sumogamma_fork_" + std::to_string(getpid()) + ".net.xml");
  std::ofstream(file) << kFork;
  const RoadNetwork net = read_sumo_net(file);
  std::filesystem::remove(file);
  const LaneLocator locator(net);
  Workers workers;
  RuleMonitor monitor(kRuleStep, net, locator);
  const AgentTypeTable types = default_agent_types();
  RoadState road;
  road.signal_states = {"rG"};
  Scene scene;
  AgentState agent;
  agent.type = find_agent_type(types, "car");
  agent.footprint = box_footprint(4.5, 1.8);
  append_agent(scene, agent);
  for (double s = 30; s < 90; s += 1.0) {
    scene.time += kRuleStep;
    const bool turned = GetParam() && s > 55;
    scene.position[0] = turned ? Vec2(55, 55 - s) : Vec2(s, 0);
    scene.heading[0] = turned ? -kPi / 2 : 0.0;
    scene.velocity[0] = 10 * direction_of(scene.heading[0]);
    monitor.add(scene, types, road, workers);
  }
  EXPECT_EQ(monitor.result(types).all.signal_crossings, 1u);
  EXPECT_EQ(monitor.result(types).all.red_light_crossings, GetParam() ? 0u : 1u);
}
INSTANTIATE_TEST_SUITE_P(TurnsOrNot, Fork, ::testing::Bool());

}  // namespace
}  // namespace sumogamma
