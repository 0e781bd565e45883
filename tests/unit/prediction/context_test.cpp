#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "prediction/companions.h"
#include "prediction/flow_trust.h"
#include "prediction/gamma_predictor.h"
#include "prediction/live_predictor.h"
#include "prediction/road_guess.h"
#include "prediction/spread_calibration.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

Companion walker(const Vec2& position, const Vec2& velocity) {
  Companion agent{position, velocity, true, {}};
  for (std::size_t k = 0; k < agent.path.size(); ++k)
    agent.path[k] = 0.4 * static_cast<double>(k + 1) * velocity;
  return agent;
}

TEST(Companions, WalkTogetherAndLeaveOthersAlone) {
  // two side by side, one who overtakes them, one far away
  const std::vector<Companion> agents = {walker({0, 0}, {1.2, 0.05}),
                                         walker({0, 0.7}, {1.2, -0.05}),
                                         walker({0, -0.7}, {2.4, 0}), walker({30, 0}, {1.2, 0})};
  SpatialGrid grid;
  std::vector<std::array<Vec2, FlowMemory::kSteps>> joint;
  join_paths(agents, {1.5, 0.2, 1.0}, grid, joint);
  ASSERT_EQ(joint.size(), agents.size());
  // the pair's sideways parts are opposite: they nearly cancel
  EXPECT_LT(joint[0][11].y(), 0.5 * agents[0].path[11].y());
  EXPECT_NEAR(joint[0][11].y(), -joint[1][11].y(), 1e-12);
  EXPECT_EQ(joint[2][11], agents[2].path[11]);
  EXPECT_EQ(joint[3][11], agents[3].path[11]);
  join_paths(agents, {1.5, 0.2, 0.0}, grid, joint);
  EXPECT_EQ(joint[0][11], agents[0].path[11]);
}

TEST(Companions, DoNotIncludeWheels) {
  std::vector<Companion> agents = {walker({0, 0}, {1.2, 0.1}), walker({0, 0.7}, {1.2, -0.1})};
  agents[1].joins = false;
  SpatialGrid grid;
  std::vector<std::array<Vec2, FlowMemory::kSteps>> joint;
  join_paths(agents, {}, grid, joint);
  EXPECT_EQ(joint[0][11], agents[0].path[11]);
  EXPECT_EQ(joint[1][11], agents[1].path[11]);
}

/// Share of a flow of 1 m to the left that is believed after truth went `truth` m to the left.
double believed(double truth) {
  FlowTrust trust;
  std::vector<Vec2> straight, flow(12, Vec2(0, 1));
  for (int k = 1; k <= 12; ++k) straight.push_back({0.5 * k, 0});
  for (std::uint32_t agent = 0; agent < 60; ++agent)
    for (int frame = 0; frame <= 12; ++frame) {
      const Vec2 start(0.5 * frame, truth * (frame % 3 == 0 ? 1.0 : 0.0));
      trust.resolve(agent, start);
      std::vector<Vec2> ahead;
      for (const Vec2& point : straight) ahead.push_back(point + Vec2(start.x(), 0));
      if (frame == 0) trust.remember(agent, 0, ahead, flow);
      // later ones start from elsewhere: nothing to learn from them
      if (frame > 0) trust.remember(agent, 0, ahead, std::vector<Vec2>(12, Vec2::Zero()));
      trust.end_frame();
    }
  EXPECT_EQ(trust.share(1), 1.0);  // the other kind learned nothing
  const double share = trust.share(0);
  trust.clear();
  EXPECT_EQ(trust.share(0), 1.0);
  return share;
}

TEST(FlowTrust, BelievesWhatCameTrue) {
  EXPECT_NEAR(believed(1.0), 1.0, 1e-9);
  EXPECT_NEAR(believed(0.5), 0.5, 0.1);
  EXPECT_EQ(believed(-1.0), 0.0);
  EXPECT_EQ(believed(3.0), 1.0);
}

/// Truth spreads `factor` times as far as was assumed: the scale must find out.
double learned_scale(double factor) {
  SpreadCalibration calibration;
  Spread spread;
  spread.forward = Vec2(0, 1);
  for (std::size_t k = 0; k < kSpreadSteps; ++k) {
    const double time = std::pow(0.4 * static_cast<double>(k + 1), 1.5);
    spread.along[k] = 0.2 * time;
    spread.across[k] = 0.1 * time;
  }
  for (std::uint32_t agent = 0; agent < 400; ++agent) {
    const Vec2 normal(random_normal(3, agent, 0, Draw::ProcessNoise),
                      random_normal(3, agent, 1, Draw::ProcessNoise));
    std::vector<Vec2> straight;
    for (int k = 1; k <= 12; ++k) straight.push_back({0, 0.5 * k});
    for (int frame = 0; frame <= 12; ++frame) {
      const double time = std::pow(0.4 * frame, 1.5);
      calibration.resolve(
          agent, Vec2(0, 0.5 * frame) + factor * time * Vec2(0.1 * normal.x(), 0.2 * normal.y()));
      calibration.remember(agent, 0, straight, spread);
      calibration.end_frame();
      // only the first prediction is compared: later ones start elsewhere
      for (Vec2& point : straight) point = Vec2(std::numeric_limits<double>::quiet_NaN(), 0);
    }
    calibration.end_frame();
  }
  EXPECT_NEAR(calibration.scale(1), 1.0, 0.02);  // the other kind learned nothing
  return calibration.scale(0);
}

TEST(SpreadCalibration, FindsOutHowFarTruthSpreads) {
  EXPECT_NEAR(learned_scale(1.0), 1.0, 0.12);
  EXPECT_NEAR(learned_scale(1.8), 1.7, 0.2);
  EXPECT_NEAR(learned_scale(0.5), 0.6, 0.15);
}

TEST(RoadGuess, KnowsTheWaysOfACrossroads) {
  const RoadNetwork network = testing::read_plain_net(testing::crossroads("priority"));
  const RoadGuess guess(network);
  const AgentTypeTable types = default_agent_types();
  const AgentType& car = type_of(types, find_agent_type(types, "car"));
  // from the south, 20 m before the junction, on its only lane
  const Vec2 position(1.6, -25);
  const auto ways = guess.ways(car, position, radians(90), 60);
  ASSERT_TRUE(ways.has_value());
  const auto end = [&](std::size_t way) { return Vec2((*ways)[way].point_at(60)); };
  EXPECT_GT(end(0).y(), 20);   // straight on
  EXPECT_LT(end(1).x(), -15);  // left
  EXPECT_GT(end(2).x(), 15);   // right
  // against the lane, and in the grass, there is none
  EXPECT_FALSE(guess.ways(car, position, radians(-90), 60).has_value());
  EXPECT_FALSE(guess.ways(car, {60, 60}, radians(90), 60).has_value());
  EXPECT_FALSE(RoadGuess().ways(car, position, radians(90), 60).has_value());
}

TEST(RoadGuess, KeepsTheDistanceToTheLine) {
  const Polyline line({{0, 0}, {10, 0}, {10, 10}});
  const std::array<double, 2> progress = {5, 15};
  std::array<Vec2, 2> way;
  follow_line(line, {2, -0.5}, progress, way);
  EXPECT_LT((way[0] - Vec2(5, 0)).norm(), 1e-12);
  EXPECT_LT((way[1] - (Vec2(10.5, 7) - Vec2(2, -0.5))).norm(), 1e-12);
}

/// A car on an arc of road: whoever knows the road predicts the bend before the car shows it.
TEST(LivePredictor, FollowsTheRoadIntoABend) {
  testing::PlainNet plain;
  plain.nodes = R"(<node id="A" x="0" y="0"/><node id="B" x="100" y="60"/>)";
  plain.edges =
      R"(<edge id="AB" from="A" to="B" numLanes="1" speed="13" shape="0,0 60,0 80,8 92,25 100,60"/>)";
  const RoadNetwork network = testing::read_plain_net(plain);
  const Polyline& line = network.lane(network.lane_by_name.at("AB_0")).centerline;
  const AgentTypeTable types = default_agent_types();
  auto errors = [&](const RoadNetwork* road) {
    LivePredictor live(types, live_predictor_parameters(), road);
    Scene scene;
    AgentState state;
    state.type = find_agent_type(types, "car");
    state.footprint = box_footprint(4, 1.8);
    append_agent(scene, state);
    for (int tick = 0; tick < 40; ++tick) {
      scene.time = 0.4 * tick;
      const double along = 5 + 8 * scene.time;
      scene.position[0] = line.point_at(along);
      scene.heading[0] = heading_of(line.direction_at(along));
      live.observe(scene);
    }
    EXPECT_GT(live.score().predictions, 10);
    return live.score().final;
  };
  EXPECT_LT(errors(&network), 0.6 * errors(nullptr));
}

TEST(GammaPredictor, NobodyWalksThroughAWall) {
  TrackSet set;
  set.name = "made";
  Track track{1, {}, 0, {}, {}};
  for (int k = 0; k < 8; ++k) {
    track.position.push_back({0.5 * k, 0});
    track.heading.push_back(0);
  }
  set.tracks.push_back(track);
  set.last_frame = 7;
  const std::vector<Obstacle> wall = {{ObstacleKind::Building, {{5, -5}, {6, -5}, {6, 5}, {5, 5}}}};
  auto end = [&](const std::vector<Obstacle>& obstacles, bool use) {
    PredictorOptions options;
    options.use_obstacles = use;
    GammaPredictor predictor(recorded_agent_types(), default_predictor_parameters(), options, 0.4,
                             obstacles);
    for (int frame = 0; frame < 8; ++frame) predictor.observe(observe(set, frame));
    return Vec2(predictor.forecast(12).row(0)[11]).x();
  };
  EXPECT_GT(end({}, true), 7);
  EXPECT_LT(end(wall, true), 5);
  EXPECT_GT(end(wall, false), 7);
}

TEST(TrackSet, BringsThePolygonsThatStandBesideIt) {
  const auto folder = std::filesystem::temp_directory_path() / "sumogamma_beside";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "yard.txt") << "0 1 0 0\n10 1 1 0\n";
  std::ofstream(folder / "yard_obstacles.json")
      << R"({"polygons": [{"vertices_m": [[0, 0], [1, 0], [1, 1]]}]})";
  EXPECT_EQ(read_track_set(folder / "yard.txt").obstacles.size(), 1u);
  for (const char* text :
       {"{", R"({"polygons": [{"vertices_m": [[0, 0], [1, 0]]}]})", R"({"polygons": [{}]})"}) {
    std::ofstream(folder / "yard_obstacles.json") << text;
    EXPECT_THROW(read_track_set(folder / "yard.txt"), Error) << text;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sumogamma
