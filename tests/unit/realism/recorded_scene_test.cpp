#include "realism/recorded_scene.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "realism/closed_loop.h"
#include "realism/controls.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

class RecordedSceneTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("sumogamma_recorded_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A car that brakes from 10 m/s by 0.5 m/s^2 on the x axis, a walker without a size beside it
  /// at 1 m/s; a frame every `period` [s].
  fs::path braking(double period, bool rate = true) const {
    const fs::path file = folder_ / "braking.csv";
    std::ofstream out(file);
    out << (rate ? "time_s" : "frame") << ",agent_id,agent_type,x_m,y_m,length_m,width_m\n";
    for (int k = 0; k * period < 20.0; ++k) {
      const double time = k * period;
      out << (rate ? time : k) << ",1,car," << along(time) << ",0,4.4,1.7\n";
      out << (rate ? time : k) << ",2,pedestrian," << 10 + time << ",5,,\n";
    }
    return file;
  }
  static double along(double time) { return 10.0 * time - 0.25 * time * time; }
  fs::path folder_;
};

// Detectors guess where a body points before they see it move.
TEST_F(RecordedSceneTest, NobodyRollsAgainstItsHeading) {
  const fs::path file = folder_ / "guessed.csv";
  std::ofstream out(file);
  out << "time_s,agent_id,agent_type,x_m,y_m,heading_rad\n";
  for (int k = 0; k < 40; ++k) {
    out << 0.1 * k << ",1,car," << -0.8 * k << ",0," << (k < 3 ? 0.1 : 3.1) << "\n";
    out << 0.1 * k << ",2,car," << -0.1 * k << ",9," << 0.1 << "\n";  // may back up
  }
  out.close();
  const RecordedScene scene = read_recorded_scene(file);
  for (int step = 0; step < 40; ++step) {
    EXPECT_NEAR(std::cos(scene.agents[0].at(step).heading), -1.0, 1e-2) << step;
    EXPECT_NEAR(scene.agents[1].at(step).heading, 0.1, 1e-6);
  }
  EXPECT_NEAR(std::cos(scene.agents[0].known_at(2).heading), -1.0, 1e-2);
  EXPECT_NE(scene.notes.back().find("3 annotated headings"), std::string::npos);
}

TEST_F(RecordedSceneTest, IsSmoothAtTenHertzWhateverTheFrames) {
  for (const double period : {0.1, 0.4, 0.25}) {
    SCOPED_TRACE(period);
    const RecordedScene scene = read_recorded_scene(braking(period));
    ASSERT_EQ(scene.agents.size(), 2u);
    const RecordedAgent& car = scene.agents[0];
    EXPECT_FALSE(car.default_box);
    EXPECT_EQ(car.length, 4.4);
    EXPECT_EQ(scene.default_boxes, 1u);
    EXPECT_EQ(scene.agents[1].length, type_of(scene.types, scene.agents[1].type).length);
    for (int step = car.first; step <= car.last(); ++step) {
      const double time = kScoreStep * step;
      EXPECT_NEAR(car.at(step).position.x(), along(time), 1e-3);
      EXPECT_NEAR(car.at(step).velocity.x(), 10.0 - 0.5 * time, 5e-3);
      EXPECT_NEAR(car.at(step).heading, 0.0, 1e-9);
    }
  }
}

/// What comes after a moment changes nothing in what is known at it.
TEST_F(RecordedSceneTest, KnowsThePastAlone) {
  const fs::path file = braking(0.1);
  const RecordedScene scene = read_recorded_scene(file);
  std::ofstream other(folder_ / "other.csv");
  other << "time_s,agent_id,agent_type,x_m,y_m,length_m,width_m\n";
  for (int k = 0; k < 100; ++k) {
    const double time = 0.1 * k;
    other << time << ",1,car," << along(std::min(time, 5.0)) << "," << (time > 5.0 ? time : 0.0)
          << ",4.4,1.7\n";
  }
  other.close();
  const RecordedScene turned = read_recorded_scene(folder_ / "other.csv");
  const MotionState a = scene.agents[0].known_at(50), b = turned.agents[0].known_at(50);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.heading, b.heading);
  EXPECT_NEAR(a.velocity.x(), 7.5, 1e-4);
  EXPECT_GT((scene.agents[0].at(50).velocity - turned.agents[0].at(50).velocity).norm(), 0.1);
}

TEST_F(RecordedSceneTest, RefusesWhatHasNoRate) {
  EXPECT_THROW(read_recorded_scene(braking(0.1, false)), Error);
  SceneReading reading;
  reading.tracks.period = 0.1;
  EXPECT_NEAR(read_recorded_scene(braking(0.1, false), reading).agents[0].at(50).velocity.x(), 7.5,
              1e-3);
  EXPECT_THROW(read_recorded_scene(braking(1.0)), Error);
  reading.boxes["dragon"] = {1, 1};
  EXPECT_THROW(read_recorded_scene(braking(0.1), reading), Error);
}

TEST_F(RecordedSceneTest, PutsTheCentreAheadOfARearAxle) {
  SceneReading reading;
  reading.point = RecordedPoint::RearAxle;
  const RecordedScene axle = read_recorded_scene(braking(0.1), reading);
  const RecordedScene centre = read_recorded_scene(braking(0.1));
  const double ahead = type_of(axle.types, axle.agents[0].type).rear_axle_to_center;
  EXPECT_NEAR(axle.agents[0].at(20).position.x() - centre.agents[0].at(20).position.x(), ahead,
              1e-6);
  EXPECT_EQ(axle.agents[1].at(20).position, centre.agents[1].at(20).position);
}

TEST_F(RecordedSceneTest, WindowsBeginEveryTenSecondsForWhoStays) {
  const RecordedScene scene = read_recorded_scene(braking(0.1));
  const Windows windows = windows_of(scene);
  ASSERT_EQ(windows.windows.size(), 2u);
  EXPECT_EQ(windows.windows[0].start, 10);
  EXPECT_EQ(windows.windows[1].start, 110);
  EXPECT_EQ(windows.windows[1].agents.size(), 2u);
  EXPECT_EQ(windows.windows[1].bodies.present[0], Poses::kSteps);
}

TEST_F(RecordedSceneTest, ControlsAreWhatTheirNamesSay) {
  const RecordedScene scene = read_recorded_scene(braking(0.1));
  const ScoreWindow window = windows_of(scene).windows[0];
  const Rollout log = replay_log(scene, window)[0], still = stand_still(scene, window)[0],
                cv = keep_velocity(scene, window)[0];
  const std::size_t last = Poses::kSteps - 1;
  EXPECT_NEAR(log.poses.position[last].x(), along(9.0), 1e-3);
  EXPECT_NEAR(still.poses.position[last].x(), along(1.0), 1e-3);
  EXPECT_NEAR(cv.poses.position[last].x(), along(1.0) + 8.0 * 9.5, 2e-2);
  const std::vector<Rollout> fan = fan_out(scene, window, 1, 32),
                             again = fan_out(scene, window, 1, 32);
  ASSERT_EQ(fan.size(), 32u);
  double sum = 0, squares = 0;
  for (std::size_t r = 0; r < 32; ++r) {
    EXPECT_EQ(fan[r].poses.position, again[r].poses.position);
    const double x = fan[r].poses.position[last].x();
    sum += x / 32.0;
    squares += x * x / 32.0;
  }
  // an acceleration of 0.8 m/s^2 for 3 s and what is won by it for 5 s more: 15.6 m
  EXPECT_NEAR(std::sqrt(squares - sum * sum), 15.6, 5.0);
}

/// Two cars on one line towards each other's place: the model lets them pass, constant velocity
/// doesn't.
TEST_F(RecordedSceneTest, ClosedLoopAvoidsWhatConstantVelocityHits) {
  std::ofstream out(folder_ / "head_on.csv");
  out << "time_s,agent_id,agent_type,x_m,y_m,length_m,width_m\n";
  for (int k = 0; k < 120; ++k) {
    const double time = 0.1 * k, aside = 2.5 * std::sin(std::min(3.14159, 0.35 * time));
    out << time << ",1,car," << 5 * time << "," << -aside << ",4.4,1.7\n";
    out << time << ",2,car," << 45 - 5 * time << "," << aside << ",4.4,1.7\n";
  }
  out.close();
  const RecordedScene scene = read_recorded_scene(folder_ / "head_on.csv");
  const ScoreWindow window = windows_of(scene).windows[0];
  Workers alone;
  const ClosedLoop loop(scene, {}, default_agent_types(), alone);
  EntryCounts entries;
  const Rollout rollout = loop.drive(window, 1, entries);
  const MotionFeatures features = features_of(rollout.poses, window.bodies);
  double nearest = std::numeric_limits<double>::infinity();
  for (const double gap : features.nearest) nearest = std::fmin(nearest, gap);
  EXPECT_GT(nearest, 0.0);
  const std::size_t last = window.bodies.present[0] - 1;
  EXPECT_GT(rollout.poses.position[last].x(), 25.0);
  EXPECT_EQ(entries.entered, 0u);
  // another seed, other drivers
  EXPECT_NE(loop.drive(window, 2, entries).poses.position[last], rollout.poses.position[last]);
  EXPECT_EQ(loop.drive(window, 1, entries).poses.position, rollout.poses.position);
}

TEST(DesiredSpeed, LiesBetweenTheSpeedOfNowAndThatOfOpenGround) {
  const AgentTypeTable types = scored_agent_types();
  const AgentType& car = type_of(types, find_agent_type(types, "car"));
  double least = 1e9, most = 0, sum = 0;
  for (std::uint32_t id = 0; id < 2000; ++id) {
    const double speed = desired_speed(car, 4.0, 1, id);
    least = std::min(least, speed);
    most = std::max(most, speed);
    sum += speed / 2000.0;
  }
  EXPECT_GE(least, 4.0 * 0.7 - 1e-9);
  EXPECT_LE(most, 8.3 * 1.3 + 1e-9);
  EXPECT_NEAR(sum, 4.0 + 4.3 / 3.0, 0.1);
  // who is faster than that keeps its speed
  EXPECT_NEAR(desired_speed(car, 20.0, 1, 3) / 20.0, 1.0, 0.3 + 1e-9);
}

}  // namespace
}  // namespace sumogamma
