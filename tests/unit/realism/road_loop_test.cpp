#include "realism/road_loop.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "base/error.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

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
    const RoadLoop loop(scene_, road, {}, BehaviorPreset::Interaction, workers_);
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

TEST(LimitFactor, IsSumosDrawAndNoSlowerThanNow) {
  double sum = 0;
  for (std::uint32_t id = 0; id < 2000; ++id) sum += limit_factor(0, 14, 1, id);
  EXPECT_NEAR(sum / 2000, 1.0, 0.01);
  EXPECT_DOUBLE_EQ(limit_factor(28, 14, 1, 3), 2.0);
  EXPECT_EQ(limit_factor(5, 14, 1, 3), limit_factor(5, 14, 1, 3));
}

}  // namespace
}  // namespace sumogamma
