#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

ProcessResult score(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {SUMOGAMMA_PROGRAM, "score", "--quiet"});
  return run_process({.arguments = std::move(arguments),
                      .environment = {},
                      .folder = {},
                      .time_limit = 600.0,
                      .output_limit = 1 << 24,
                      .should_stop = {}});
}

class ScoreCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("score_command_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Two cars one behind the other, a car the other way, a walker across who waits for none of
  /// them, and a car that comes after five seconds; 10 Hz.
  std::string small_recording(double seconds) const {
    const fs::path file = folder_ / ("small_" + std::to_string(int(seconds)) + ".csv");
    std::ofstream out(file);
    out << "time_s,agent_id,agent_type,x_m,y_m,heading_rad,length_m,width_m\n";
    for (int step = 0; step <= std::lround(10 * seconds); ++step) {
      const double time = 0.1 * step;
      out << time << ",1,car," << 8 * time << ",0,0,4.6,1.9\n";
      out << time << ",2,car," << -20 + 8 * time << ",0,0,4.6,1.9\n";
      out << time << ",3,car," << 120 - 7 * time << ",4,3.14159265,4.6,1.9\n";
      out << time << ",4,pedestrian,140," << -15 + 1.3 * time << ",1.5707963,,\n";
      if (time >= 5) out << time << ",5,car," << -60 + 9 * (time - 5) << ",0,0,4.6,1.9\n";
    }
    return file.string();
  }

  json results() const { return json::parse(std::ifstream(folder_ / "out" / "score.json")); }
  std::string out() const { return (folder_ / "out").string(); }
  fs::path folder_;
};

const json& method_named(const json& recording, const std::string& name) {
  for (const json& method : recording.at("methods"))
    if (method.at("method") == name) return method;
  throw std::runtime_error("no method " + name);
}

TEST_F(ScoreCommand, ScoresControlsAndGammaOnASmallRecording) {
  const ProcessResult result = score({small_recording(22), "-o", out(), "--seeds", "4"});
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_NE(result.output.find("everybody stands"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("1 of 5 agents have no size in it"), std::string::npos);
  EXPECT_NE(result.output.find("no noise floor"), std::string::npos);
  const json recording = results().at("recordings").at(0);
  EXPECT_EQ(recording.at("windows"), 2);
  EXPECT_EQ(recording.at("agents_scored"), 9) << "the fifth car in the second window alone";
  const json &log = method_named(recording, "log"), &stand = method_named(recording, "stand"),
             &cv = method_named(recording, "cv"), &gamma = method_named(recording, "gamma");
  // who keeps its velocity is foretold by it
  EXPECT_NEAR(cv.at("composite").get<double>(), log.at("composite").get<double>(), 1e-6);
  EXPECT_NEAR(cv.at("min_ade_m").get<double>(), 0.0, 1e-6);
  EXPECT_NEAR(cv.at("progress").get<double>(), 1.0, 1e-6);
  EXPECT_EQ(stand.at("progress"), 0.0);
  EXPECT_LT(stand.at("likelihood_speed"), 0.5);
  EXPECT_NEAR(log.at("hellinger").at("speed").get<double>(), 0.0, 1e-6);
  EXPECT_GT(stand.at("hellinger").at("speed"), 0.9);
  EXPECT_TRUE(recording.at("noise_floor").at("speed").is_null());
  // moved by the model, towards where they went
  EXPECT_EQ(gamma.at("rollouts"), 4);
  EXPECT_EQ(gamma.at("entering").at("entered"), 4);
  EXPECT_EQ(gamma.at("colliding"), 0.0);
  EXPECT_GT(gamma.at("progress"), 0.8);
  EXPECT_LT(gamma.at("progress"), 1.2);
  EXPECT_GT(gamma.at("composite"), stand.at("composite"));
  EXPECT_TRUE(gamma.at("by_type").contains("pedestrian"));
  std::ifstream csv(folder_ / "out" / "score.csv");
  std::string head;
  std::getline(csv, head);
  EXPECT_EQ(head, "recording,method,types,figure,value");
}

TEST_F(ScoreCommand, IsTheSameForAnyNumberOfThreads) {
  const std::string recording = small_recording(14);
  const ProcessResult one = score({recording, "--seeds", "3", "--method", "cv-fan,gamma"});
  const ProcessResult two =
      score({recording, "--seeds", "3", "--method", "cv-fan,gamma", "--threads", "2"});
  ASSERT_TRUE(one.ok()) << one.errors;
  EXPECT_EQ(one.output, two.output);
  const ProcessResult other =
      score({recording, "--seeds", "3", "--method", "cv-fan,gamma", "--seed", "7"});
  EXPECT_NE(one.output, other.output);
  const ProcessResult slow = score(
      {recording, "--seeds", "3", "--method", "cv-fan,gamma", "--set", "types.car.max_speed=3"});
  ASSERT_TRUE(slow.ok()) << slow.errors;
  EXPECT_NE(one.output, slow.output) << "how types drive is the user's to say";
}

/// On the network of the place GAMMA and SUMO's models drive what the recording's cars did.
TEST_F(ScoreCommand, DrivesOnANetworkBesideSumosModels) {
  const fs::path net = folder_ / "road.net.xml";
  testing::write_plain_net(
      {R"(<node id="W" x="-100" y="0"/><node id="C" x="60" y="0"/><node id="E" x="400" y="0"/>)",
       R"(<edge id="WC" from="W" to="C" numLanes="1" speed="10" spreadType="center"/>)"
       R"(<edge id="CE" from="C" to="E" numLanes="1" speed="10" spreadType="center"/>)"
       R"(<edge id="EW" from="E" to="W" numLanes="1" speed="10" shape="400,4 -100,4" )"
       R"(spreadType="center"/>)",
       "",
       {}},
      net);
  const ProcessResult result =
      score({small_recording(22), "-o", out(), "--seeds", "3", "--map", net.string(), "--free", "2",
             "--method", "log,gamma,sumo-krauss,sumo-idm,sumo-eidm,sumo-sublane"});
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_NE(result.output.find("left out of all methods are 1 people"), std::string::npos)
      << result.output;
  const json recording = results().at("recordings").at(0);
  EXPECT_EQ(recording.at("map").at("network"), "road.net.xml");
  EXPECT_EQ(recording.at("agents_scored"), 7) << "three cars, and four in the second window";
  for (const char* name : {"gamma", "sumo-krauss", "sumo-idm", "sumo-eidm", "sumo-sublane"}) {
    const json& method = method_named(recording, name);
    EXPECT_EQ(method.at("rollouts"), 3) << name;
    EXPECT_EQ(method.at("colliding"), 0.0) << name;
    EXPECT_GT(method.at("progress"), 0.85) << name;
    EXPECT_LT(method.at("progress"), 1.4) << name;
    EXPECT_LT(method.at("min_ade_m"), 8.0) << name;
    EXPECT_EQ(method.at("off_road"), 0.0) << name;
    EXPECT_GT(method.at("likelihood_road_edge"), 0.9) << name;
  }
  ASSERT_EQ(recording.at("free_runs").size(), 5u);
  for (const json& run : recording.at("free_runs")) {
    EXPECT_EQ(run.at("runs"), 2) << run;
    EXPECT_LT(run.at("hellinger").at("speed"), 0.95) << run;
    EXPECT_LT(run.at("hellinger").at("nearest"), 0.8) << run;
    EXPECT_EQ(run.at("colliding"), 0.0) << run;
    EXPECT_EQ(run.at("left_in_log"), 0.0) << "all are there until the end";
    EXPECT_TRUE(run.at("travel_time_rmspe").is_null()) << run;
  }
  EXPECT_NE(result.output.find("| free runs, Hellinger distance |"), std::string::npos);
  std::ifstream stream(folder_ / "out" / "score.html");
  const std::string page(std::istreambuf_iterator<char>(stream), {});
  EXPECT_NE(page.find("Free runs (2 a method)"), std::string::npos);
  EXPECT_NE(page.find("distribution of speed"), std::string::npos);
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& why) {
    const ProcessResult none = score(arguments);
    EXPECT_EQ(none.exit_code, 2) << none.errors;
    EXPECT_NE(none.errors.find(why), std::string::npos) << none.errors;
  };
  refused({small_recording(22), "--method", "sumo-idm"}, "--map NAME.net.xml tells which");
  refused({small_recording(22), "--map", (folder_ / "no.net.xml").string()}, "no.net.xml");
}

TEST_F(ScoreCommand, RefusesWhatItCantScore) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& why) {
    const ProcessResult result = score(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(why), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  };
  const std::string whole = small_recording(14);
  refused({whole, "--method", "gama"}, "did you mean gamma?");
  refused({small_recording(5)}, "expected 9.2 s");
  refused({(folder_ / "absent.csv").string()}, "absent.csv");
  std::ofstream(folder_ / "words.csv") << "some words\nand others\n";
  refused({(folder_ / "words.csv").string()}, "words.csv");
  std::ofstream(folder_ / "nan.csv") << "time_s,agent_id,x_m,y_m\n0,1,nan,0\n0.1,1,0,0\n";
  refused({(folder_ / "nan.csv").string()}, "nan.csv:2");
  std::ofstream slow(folder_ / "slow.csv");
  slow << "time_s,agent_id,x_m,y_m\n";
  for (int k = 0; k < 20; ++k) slow << k << ",1," << k << ",0\n";
  slow.close();
  refused({(folder_ / "slow.csv").string()}, "every 1 s");
  ASSERT_TRUE(score({whole, "-o", out(), "--method", "stand"}).ok());
  refused({whole, "-o", out(), "--method", "stand"}, "holds another score.json");
}

TEST_F(ScoreCommand, LeavesOutWhatCantBeScoredByName) {
  const ProcessResult result =
      score({small_recording(14), small_recording(5), "--method", "stand", "-o", out()});
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_NE(result.errors.find("left out: " + small_recording(5)), std::string::npos)
      << result.errors;
  EXPECT_EQ(results().at("left_out").size(), 1u);
}

/// The bounds that any recording of traffic shows.
TEST_F(ScoreCommand, PutsTheLogAboveControlsOnRealRecordings) {
  const fs::path data = fs::path(SUMOGAMMA_SHARED_DIR) / "data" / "trajectories";
  const fs::path karlsruhe = data / "tafbw_k733" / "k733_2020_09_15.csv";
  if (!fs::exists(karlsruhe)) GTEST_SKIP() << "no recordings beside the project: " << karlsruhe;
  const ProcessResult result = score({karlsruhe.string(), "--period", "0.1", "-o", out(),
                                      "--method", "log,stand,cv,cv-fan", "--seeds", "32"});
  ASSERT_TRUE(result.ok()) << result.errors;
  const json recording = results().at("recordings").at(0);
  EXPECT_EQ(recording.at("windows"), 15);
  const double log = method_named(recording, "log").at("composite");
  for (const char* name : {"stand", "cv", "cv-fan"})
    EXPECT_LT(method_named(recording, name).at("composite"), log) << name;
  EXPECT_GT(log, 0.7);
}

TEST_F(ScoreCommand, DrivesMixedTrafficBetterThanConstantVelocity) {
  const fs::path cross = fs::path(SUMOGAMMA_SHARED_DIR) / "data" / "trajectories" / "cross.csv";
  if (!fs::exists(cross)) GTEST_SKIP() << "no recordings beside the project: " << cross;
  EXPECT_NE(score({cross.string()}).errors.find("tells no rate"), std::string::npos);
  const ProcessResult result = score({cross.string(), "--period", "0.4", "-o", out(), "--method",
                                      "log,stand,cv,gamma", "--seeds", "8"});
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_NE(result.output.find("211 of 211 agents have no size in it"), std::string::npos);
  const json recording = results().at("recordings").at(0);
  const json &cv = method_named(recording, "cv"), &gamma = method_named(recording, "gamma");
  EXPECT_GT(gamma.at("composite"), cv.at("composite"));
  EXPECT_LT(gamma.at("colliding"), cv.at("colliding"));
  EXPECT_LT(gamma.at("min_ade_m"), cv.at("min_ade_m"));
  EXPECT_NEAR(gamma.at("progress").get<double>(), 1.0, 0.3);
}

}  // namespace
}  // namespace sumogamma
