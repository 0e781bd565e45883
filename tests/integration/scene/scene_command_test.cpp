#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace sumogamma {
namespace {

using Json = nlohmann::json;

struct Outcome {
  int code = 0;
  std::string output;
};

Outcome run(const std::string& arguments) {
  const std::string command = std::string(SUMOGAMMA_PROGRAM) + " " + arguments + " 2>&1";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (fgets(buffer.data(), buffer.size(), pipe)) outcome.output += buffer.data();
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

std::string shared_scene(const std::string& name) {
  return std::string(SUMOGAMMA_SHARED_DIR) + "/data/scenes/" + name + ".csv";
}

#define SKIP_WITHOUT_SCENES()                              \
  if (!std::filesystem::exists(shared_scene("pairs_car"))) \
  GTEST_SKIP() << "no scene set beside the project: " << shared_scene("pairs_car")

Json figures(const std::string& name, const std::string& options = "") {
  const Outcome outcome = run("scene " + shared_scene(name) + " --threads 2 " + options);
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  return Json::parse(outcome.output);
}

class SceneCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("scene_command_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream(scene()) << "id,type,x,y,heading_rad,speed,goal_x,goal_y,pref_speed\n"
                              "0,Car,0,0,0,0,100,0,4\n1,People,20,1,3.1,1,-80,1,1.2\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string scene() const { return (folder_ / "small.csv").string(); }
  std::filesystem::path folder_;
};

TEST_F(SceneCommand, PrintsEveryKeyOfTheInterface) {
  const Outcome outcome = run("scene " + scene() + " --steps 40 --dt 0.1");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  const Json json = Json::parse(outcome.output);
  for (const char* key :
       {"scene", "agents", "steps", "dt", "agents_overlapped_share", "pairs_per_agent",
        "overlap_share_of_agent_steps", "deep_agents_share", "progress_mean", "stuck_share",
        "infeasible_share", "reversal_share", "kinematics_violation_share", "neighbours_mean",
        "half_planes_mean", "model_cpu_us_per_agent_step", "state_hash"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["scene"], "small");
  EXPECT_EQ(json["agents"], 2);
  EXPECT_EQ(json["steps"], 40);
}

TEST_F(SceneCommand, SameBytesForAnyNumberOfThreads) {
  const std::string one =
      Json::parse(run("scene " + scene() + " --threads 1").output)["state_hash"];
  EXPECT_EQ(Json::parse(run("scene " + scene() + " --threads 5").output)["state_hash"], one);
  EXPECT_NE(Json::parse(run("scene " + scene() + " --actuation ideal").output)["state_hash"], one);
  EXPECT_NE(Json::parse(run("scene " + scene() +
                            " --set model.use_avoidance=false --set model.use_guard=false")
                            .output)["state_hash"],
            "");
}

TEST_F(SceneCommand, WritesAReplayPage) {
  const std::string page = (folder_ / "page.html").string();
  EXPECT_EQ(run("scene " + scene() + " --steps 40 --replay " + page).code, 0);
  EXPECT_GT(std::filesystem::file_size(page), 10000u);
}

TEST_F(SceneCommand, BadInputIsOneLineAndCodeTwo) {
  std::ofstream(folder_ / "bad.csv")
      << "id,type,x,y,heading_rad,speed,goal_x,goal_y,pref_speed\n0,Car,zero,0,0,0,1,1,1\n";
  for (const std::string& arguments :
       {"scene " + (folder_ / "bad.csv").string(), std::string("scene /no/such.csv"),
        "scene " + scene() + " --actuation magic", "scene " + scene() + " --steps 0",
        "scene " + scene() + " --set model.no_such_key=1"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.output.rfind("sumo-gamma: ", 0), 0u) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  }
}

TEST(SceneFigures, DenseTrafficFlowsNearlyWithoutContact) {
  SKIP_WITHOUT_SCENES();
  const Json dense = figures("dense_1000");
  EXPECT_LE(dense["agents_overlapped_share"], 0.02);
  EXPECT_LE(dense["pairs_per_agent"], 0.02);
  EXPECT_GE(dense["progress_mean"], 0.75);
  EXPECT_EQ(dense["reversal_share"], 0.0);
  EXPECT_EQ(dense["kinematics_violation_share"], 0.0);
  EXPECT_EQ(dense["hard_violation_share"], 0.0);
  const Json sparse = figures("sparse_1000");
  EXPECT_LE(sparse["agents_overlapped_share"], 0.002);
  EXPECT_GE(sparse["progress_mean"], 0.92);
}

TEST(SceneFigures, PairsPassEachOtherAndNobodyIsStuck) {
  SKIP_WITHOUT_SCENES();
  for (const char* name : {"pairs_car", "pairs_mix", "pairs_headon_mix", "pairs_headon_exact",
                           "stopped_ahead", "follow"}) {
    SCOPED_TRACE(name);
    const Json pairs = figures(name, "--steps 400");
    EXPECT_EQ(pairs["agents_overlapped_share"], 0.0);
    EXPECT_EQ(pairs["stuck_share"], 0.0);
  }
}

TEST(SceneFigures, OverlapComesApart) {
  SKIP_WITHOUT_SCENES();
  EXPECT_LE(figures("overlap_same", "--steps 400")["overlap_share_of_agent_steps"], 0.052);
  EXPECT_LE(figures("overlap_ped", "--steps 400")["overlap_share_of_agent_steps"], 0.02);
}

}  // namespace
}  // namespace sumogamma
