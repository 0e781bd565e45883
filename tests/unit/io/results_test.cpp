#include "io/results.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/output_file.h"
#include "io/report.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

class Results : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("sumogamma_results_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(Results, EveryKeyIsThereInAnEmptyRun) {
  const nlohmann::json written = nlohmann::json::parse(results_json(RunResults{}));
  for (const char* key : {"sumo_version", "sumo_gamma_version", "metrics_version", "scenario",
                          "seed", "step", "duration", "backend", "threads", "agents", "timing",
                          "collisions", "flow", "rules", "smoothness", "coupling", "state_hash"})
    EXPECT_TRUE(written.contains(key)) << key;
  const std::map<std::string, std::vector<std::string>> inner{
      {"agents",
       {"inserted", "arrived", "controlled_now", "controlled_peak", "controlled_mean", "by_type",
        "removed", "left_to_sumo", "stops_served", "rides"}},
      {"behavior", {"preset", "by_type"}},
      {"timing", {"wall_s", "real_time_factor", "cpu_s", "share", "model_cpu_us_per_agent_step"}},
      {"collisions",
       {"unique_pairs", "unique_pairs_per_agent_hour", "overlap_share_of_agent_steps", "deep_pairs",
        "by_types", "worst_penetration_m"}},
      {"flow",
       {"mean_speed", "distance_km", "stuck_agents", "longest_standstill_s", "held_agents",
        "longest_held_s", "waiting_time_mean_s"}},
      {"rules",
       {"red_light_crossings", "red_lights_met", "mid_block_crossings", "wrong_way_s",
        "overtaking_s", "off_road_s", "sidewalk_by_vehicle_s", "by_types"}},
      {"smoothness", {"accel_p95", "jerk_p95", "yaw_rate_p95", "lateral_slip_p95", "reversals"}},
      {"coupling",
       {"position_error_max_m", "position_error_p99_m", "lane_mismatches", "teleports",
        "emergency_stops", "sumo_warnings"}}};
  for (const auto& [section, keys] : inner)
    for (const std::string& key : keys)
      EXPECT_TRUE(written.at(section).contains(key)) << section << "." << key;
  for (const char* key : {"observe", "context", "model", "track", "advance_sumo", "record"})
    EXPECT_TRUE(written.at("timing").at("share").contains(key)) << key;
}

TEST_F(Results, SaysHowThoseBehavedWhoCame) {
  RunResults results;
  results.preset = "observed";
  results.types = default_agent_types();
  results.types[static_cast<std::size_t>(find_agent_type(results.types, "bicycle"))]
      .compliance.red_light_running = 0.26;
  results.agents.by_type["bicycle"] = {3, 2};
  const nlohmann::json behavior = nlohmann::json::parse(results_json(results)).at("behavior");
  EXPECT_EQ(behavior.at("preset"), "observed");
  EXPECT_EQ(behavior.at("by_type").size(), 1u);
  EXPECT_EQ(behavior.at("by_type").at("bicycle").at("red_light_running"), 0.26);
  EXPECT_EQ(behavior.at("by_type").at("bicycle").at("critical_gap"), 1.0);
}

TEST_F(Results, HashKeepsAll64Bits) {
  RunResults results;
  results.state_hash = 0xfedcba9876543210ULL;
  EXPECT_EQ(nlohmann::json::parse(results_json(results)).at("state_hash"), "fedcba9876543210");
}

TEST_F(Results, FilesAreReplacedAsAWhole) {
  const fs::path file = folder_ / "results.json";
  write_results(file, RunResults{});
  RunResults again;
  again.scenario = "second";
  write_results(file, again);
  EXPECT_EQ(nlohmann::json::parse(read_file(file)).at("scenario"), "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1)
      << "nothing half-written stays";
}

TEST_F(Results, AFullDiskIsAnErrorThatNamesTheFile) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  try {
    write_results("/dev/full", RunResults{});
    FAIL() << "expected an error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full"), std::string::npos);
  }
  EXPECT_THROW(write_results(folder_ / "absent" / "results.json", RunResults{}), Error);
  EXPECT_THROW(make_output_folder("/dev/null/run"), Error);
}

TEST_F(Results, ReportPutsRunsSideBySide) {
  RunResults one, other;
  one.flow.mean_speed = 4;
  other.flow.mean_speed = 5;
  other.collisions.by_types["car-car"] = 3;
  other.scenario = "a|b<c>";
  fs::create_directories(folder_ / "one");
  fs::create_directories(folder_ / "other");
  write_results(folder_ / "one" / "results.json", one);
  write_results(folder_ / "other" / "results.json", other);
  const std::vector<fs::path> folders{folder_ / "one", folder_ / "other"};
  const auto runs = read_runs(folders);
  const std::string markdown = report_markdown(runs);
  EXPECT_NE(markdown.find("| key | one | other |"), std::string::npos);
  EXPECT_NE(markdown.find("| flow.mean_speed | 4 | 5 |"), std::string::npos);
  EXPECT_NE(markdown.find("| collisions.by_types.car-car |  | 3 |"), std::string::npos);
  EXPECT_NE(markdown.find("a\\|b<c>"), std::string::npos);
  EXPECT_NE(report_csv(runs).find("flow.mean_speed,4,5"), std::string::npos);
  const std::string html = report_html(runs);
  EXPECT_NE(html.find("+25 %"), std::string::npos);
  EXPECT_NE(html.find("a|b&lt;c&gt;"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos) << "nothing from the network";
}

TEST_F(Results, FiguresOfOtherDefinitionsAreNotCompared) {
  const RunColumn::Value one{"metrics_version", "1", 1, true}, two{"metrics_version", "2", 2, true};
  const std::vector<RunColumn> same{{"a", {one}}, {"b", {one}}};
  const std::vector<RunColumn> changed{{"a", {one}}, {"b", {two}}}, older{{"a", {one}}, {"b", {}}};
  EXPECT_TRUE(same_metrics(same));
  EXPECT_FALSE(same_metrics(changed));
  EXPECT_FALSE(same_metrics(older));
}

TEST_F(Results, ReportRefusesWhatIsNoResult) {
  std::ofstream(folder_ / "results.json") << "{\"a\": 1}";
  const std::vector<fs::path> folders{folder_};
  EXPECT_THROW(read_runs(folders), Error);
  std::ofstream(folder_ / "results.json") << "{\"a\": ";
  EXPECT_THROW(read_runs(folders), Error);
  const std::vector<fs::path> absent{folder_ / "absent"};
  EXPECT_THROW(read_runs(absent), Error);
}

TEST_F(Results, StuckAgentsAsCsv) {
  const AgentTypeTable types = default_agent_types();
  StuckAgent agent;
  agent.id = AgentId{4};
  agent.type = find_agent_type(types, "bus");
  agent.position = {1.5, -2};
  agent.since = 10;
  agent.standing = 75.25;
  agent.reason = LimitReason::Leader;
  agent.foe = 9;
  agent.head = 7;
  agent.head_reason = LimitReason::Signal;
  const std::string csv = stuck_csv({agent}, types, RoadNetwork{},
                                    [](AgentId id) { return "v" + std::to_string(id.value); });
  EXPECT_NE(csv.find("\nv4,bus,,1.50,-2.00,10.00,75.25,no,leader,v9,v7,signal\n"),
            std::string::npos)
      << csv;
}

TEST_F(Results, CollisionsAsCsv) {
  const AgentTypeTable types = default_agent_types();
  const CollisionPair pair{12.5,
                           AgentId{2},
                           AgentId{7},
                           find_agent_type(types, "bus"),
                           find_agent_type(types, "car"),
                           {1, -2.5},
                           0.125,
                           3};
  const std::string csv =
      collisions_csv({pair}, types, [](AgentId id) { return "v" + std::to_string(id.value); });
  EXPECT_NE(csv.find("\nv2,bus,v7,car,1.00,-2.50,12.50,3.00,0.125\n"), std::string::npos) << csv;
}

}  // namespace
}  // namespace sumogamma
