#include "realism/road_loop.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "base/error.h"
#include "realism/drivable_area.h"
#include "realism/free_score.h"
#include "realism/map_features.h"
#include "scene/behavior_preset.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

AgentTypeTable as_at_interaction() {
  AgentTypeTable types = default_agent_types();
  apply_preset(BehaviorPreset::Interaction, types);
  return types;
}

/// A straight road of 400 m with a signal in its middle, at x = 0, and who was recorded on it.
class RoadLoopTest : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = fs::temp_directory_path() / ("road_loop_" + std::to_string(getpid()) + ".net.xml");
    testing::write_plain_net(
        {R"(<node id="W" x="-200" y="0"/><node id="C" x="0" y="0" type="traffic_light"/>)"
         R"(<node id="E" x="200" y="0"/>)",
         R"(<edge id="WC" from="W" to="C" numLanes="1" speed="14"/>)"
         R"(<edge id="CE" from="C" to="E" numLanes="1" speed="14"/>)",
         "",
         {}},
        file_);
    scene_.types = scored_agent_types();
    scene_.last = 100;
  }
  void TearDown() override { fs::remove(file_); }

  /// Goes along +x for 10 s.
  void add(const char* type, double x, double y, double speed) {
    RecordedAgent agent;
    agent.id = static_cast<std::uint32_t>(scene_.agents.size());
    agent.type = find_agent_type(scene_.types, type);
    agent.length = 4.5;
    agent.width = 1.8;
    for (int k = 0; k <= 100; ++k) {
      agent.position.emplace_back(x + kScoreStep * k * speed, y);
      agent.velocity.emplace_back(speed, 0);
      agent.heading.push_back(0.0);
    }
    agent.seen = agent.position;
    agent.seen_heading = agent.heading;
    scene_.agents.push_back(std::move(agent));
  }
  ScoreWindow window() const {
    ScoreWindow window;
    window.start = 10;
    for (std::size_t k = 0; k < scene_.agents.size(); ++k) window.agents.push_back(k);
    return window;
  }
  double end_of(const Rollout& rollout, std::size_t row) const {
    return rollout.poses.position[row * Poses::kSteps + Poses::kSteps - 1].x();
  }
  Rollout drive(RecordedRoad& road, const std::string& state) {
    for (SignalPhase& phase : road.road.network.signals.at(0).phases) phase.state = state;
    const RoadLoop loop(scene_, road, {}, as_at_interaction(), workers_);
    EntryCounts entries;
    return loop.drive(window(), 1, entries);
  }

  fs::path file_;
  RecordedScene scene_;
  Workers workers_;
};

TEST_F(RoadLoopTest, HaltsAtRedAndDrivesOnAtGreen) {
  add("car", -70, -1.6, 10);
  RecordedRoad road = put_on_road(file_, workers_, scene_);
  ASSERT_EQ(road.road.network.signals.size(), 1u);
  const std::string green(road.road.network.signals[0].size, 'G'), red(green.size(), 'r');
  const Rollout free = drive(road, green), held = drive(road, red);
  EXPECT_NEAR(free.poses.position[0].x(), -60.0, 0.1);
  EXPECT_GT(end_of(free, 0), 15.0);
  EXPECT_LT(end_of(held, 0) + 2.25, 0.5) << "its front before the line";
  EXPECT_GT(end_of(held, 0), -15.0);
}

TEST_F(RoadLoopTest, KeepsBehindWhoStands) {
  add("car", -60, -1.6, 8);
  add("car", -20, -1.6, 0);
  RecordedRoad road = put_on_road(file_, workers_, scene_);
  const Rollout rollout = drive(road, std::string(road.road.network.signals[0].size, 'r'));
  EXPECT_LT(end_of(rollout, 0) + 4.5, end_of(rollout, 1));
  EXPECT_GT(end_of(rollout, 0), -50.0);
}

TEST_F(RoadLoopTest, TakesOutWhoHasNoRoute) {
  add("car", -70, -1.6, 10);
  add("pedestrian", -70, -6, 1);
  add("bicycle", -70, -7, 4);
  const RecordedRoad road = put_on_road(file_, workers_, scene_);
  EXPECT_EQ(road.people, 1u);
  EXPECT_EQ(road.beside_lanes, 1u);
  ASSERT_EQ(scene_.agents.size(), 1u);
  EXPECT_EQ(road.routes.at(0).edges.size(), 2u);
  scene_.agents.clear();
  add("car", -70, 40, 10);
  EXPECT_THROW(put_on_road(file_, workers_, scene_), Error);
}

TEST_F(RoadLoopTest, FindsThePlaceOnARouteAndOverItsJunction) {
  add("car", -70, -1.6, 10);
  const RecordedRoad road = put_on_road(file_, workers_, scene_);
  const RoadNetwork& network = road.road.network;
  const auto place = [&](double x) {
    return place_on_route(network, road.routes[0], {{x, -1.6}, {10, 0}, 0.0},
                          vehicle_class::kPassenger);
  };
  EXPECT_EQ(network.lane(place(-100).on).name, "WC_0");
  EXPECT_NEAR(place(-100).along, 100.0, 0.5);
  EXPECT_EQ(place(100).edge, 1u);
  // on the junction it is at its lane's end
  const Lane& west = network.lane(network.lane_by_name.at("WC_0"));
  const double end = west.centerline.points().back().x(),
               begin = network.lane(network.lane_by_name.at("CE_0")).centerline.points()[0].x();
  if (begin - end > 1.0) {
    EXPECT_EQ(network.lane(place(0.5 * (begin + end)).on).kind, LaneKind::Internal);
    EXPECT_NEAR(place(0.5 * (begin + end)).along, west.centerline.length(), 1e-6);
  }
}

TEST_F(RoadLoopTest, AFreeRunEndsWhereSomebodyWasSeenLast) {
  add("car", -70, -1.6, 10);
  add("car", -150, -1.6, 6);
  // the first leaves after five seconds, 30 m before the signal
  RecordedAgent& first = scene_.agents[0];
  first.position.resize(41);
  first.velocity.resize(41);
  first.heading.resize(41);
  RecordedRoad road = put_on_road(file_, workers_, scene_);
  for (SignalPhase& phase : road.road.network.signals.at(0).phases)
    phase.state = std::string(road.road.network.signals[0].size, 'r');
  const RoadLoop loop(scene_, road, {}, as_at_interaction(), workers_);
  const FreeRun run = loop.drive_freely(1);
  ASSERT_EQ(run.driven.agents.size(), 2u);
  EXPECT_TRUE(run.arrived[0]);
  EXPECT_NEAR(run.driven.agents[0].position.back().x(), -30.0, 1.5);
  EXPECT_FALSE(run.arrived[1]) << "who was still there goes on";
  EXPECT_EQ(run.driven.agents[1].last(), 100);
  EXPECT_GT(run.driven.agents[1].position.back().x(), -110.0);
}

TEST_F(RoadLoopTest, TheMapTellsWhoLeavesTheRoadAndWhoRunsARedLight) {
  add("car", -30, -1.6, 10);
  add("car", -150, -1.6, 5);
  RecordedRoad road = put_on_road(file_, workers_, scene_);
  const auto red = std::string(road.road.network.signals.at(0).size, 'r');
  for (SignalPhase& phase : road.road.network.signals[0].phases) phase.state = red;
  const MapFeatures map(road);
  ScoreWindow of_all = window();
  Poses poses(2);
  for (std::size_t row = 0; row < 2; ++row) {
    of_all.bodies.size.emplace_back(4.5, 1.8);
    of_all.bodies.present.push_back(Poses::kSteps);
    for (std::size_t k = 0; k < Poses::kSteps; ++k) {
      const MotionState state = scene_.agents[row].at(10 + static_cast<int>(k));
      poses.position[row * Poses::kSteps + k] = state.position;
      // the second leaves the road to the right
      if (row == 1) poses.position[row * Poses::kSteps + k].y() -= 0.1 * static_cast<double>(k);
    }
  }
  MotionFeatures features = features_of(poses, of_all.bodies);
  map.add(of_all, 0, poses, features);
  EXPECT_EQ(features.ran_red[0], 1);
  EXPECT_EQ(features.ran_red[1], 0);
  // lanes of 3.2 m both ways: the right corners are 0.7 m from the edge
  EXPECT_NEAR(features.road_edge[0], -0.7, 0.05);
  EXPECT_NEAR(features.road_edge[Poses::kSteps + 80], 7.3, 0.1);
  for (SignalPhase& phase : road.road.network.signals[0].phases)
    phase.state = std::string(red.size(), 'G');
  map.add(of_all, 0, poses, features);
  EXPECT_EQ(features.ran_red[0], 0);
}

TEST_F(RoadLoopTest, TravelTimesAreComparedByWay) {
  for (int k = 0; k < 4; ++k) add("car", -70 - 20.0 * k, -1.6, 10);
  for (RecordedAgent& agent : scene_.agents)
    for (auto* values : {&agent.position, &agent.velocity}) values->resize(51);
  const RecordedRoad road = put_on_road(file_, workers_, scene_);
  FreeRun run;
  run.driven = scene_;
  run.arrived.assign(4, true);
  run.who = {0, 1, 2, 3};
  std::size_t ways = 0;
  EXPECT_NEAR(travel_time_error(scene_, &road, {run}, ways), 0.0, 1e-12);
  EXPECT_EQ(ways, 1u);
  for (RecordedAgent& agent : run.driven.agents) agent.position.resize(41);
  EXPECT_NEAR(travel_time_error(scene_, &road, {run}, ways), 0.2, 1e-12);
  // who is still on its way tells nothing
  run.arrived = {true, false, false, false};
  run.driven.agents[1].position.resize(11);
  EXPECT_NEAR(travel_time_error(scene_, &road, {run}, ways), 0.2, 1e-12);
}

TEST(DrivableArea, HasNoBorderBetweenLanesAndJunctions) {
  const fs::path file =
      fs::temp_directory_path() / ("drivable_" + std::to_string(getpid()) + ".net.xml");
  testing::write_plain_net(
      {R"(<node id="W" x="-100" y="0"/><node id="C" x="0" y="0"/><node id="E" x="100" y="0"/>)"
       R"(<node id="N" x="0" y="100"/>)",
       R"(<edge id="WC" from="W" to="C" numLanes="2" speed="14"/>)"
       R"(<edge id="CE" from="C" to="E" numLanes="2" speed="14"/>)"
       R"(<edge id="NC" from="N" to="C" numLanes="1" speed="14"/>)",
       "",
       {}},
      file);
  Workers workers;
  const DrivableArea area(read_road(file, {}, workers).network);
  fs::remove(file);
  for (double x = -90; x <= 90; x += 0.5)
    EXPECT_LT(area.signed_distance({x, -3.2}), -2.9) << "between two lanes, at " << x;
  EXPECT_NEAR(area.signed_distance({-50, 0}), 0.0, 0.01);
  EXPECT_NEAR(area.signed_distance({-50, -8.4}), 2.0, 0.01);
  EXPECT_NEAR(area.signed_distance({-1.6, 50}), -1.6, 0.05);
  EXPECT_GT(area.signed_distance({20, 20}), 10.0);
}

TEST(LimitFactor, IsSumosDrawAndNoSlowerThanNow) {
  double sum = 0;
  for (std::uint32_t id = 0; id < 2000; ++id) sum += limit_factor(0, 14, 1, id);
  EXPECT_NEAR(sum / 2000, 1.0, 0.01);
  EXPECT_DOUBLE_EQ(limit_factor(28, 14, 1, 3), 2.0);
  EXPECT_EQ(limit_factor(5, 14, 1, 3), limit_factor(5, 14, 1, 3));
}

}  // namespace
}  // namespace sumogamma
