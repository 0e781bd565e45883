#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/subprocess.h"

namespace sumogamma {
namespace {

ProcessResult predict(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {SUMOGAMMA_PROGRAM, "predict", "--quiet"});
  return run_process({.arguments = std::move(arguments),
                      .environment = {},
                      .folder = {},
                      .time_limit = 300.0,
                      .output_limit = 1 << 24,
                      .should_stop = {}});
}

/// Five walkers on straight lines, in the common text format.
std::string small_recording() {
  const auto path = std::filesystem::temp_directory_path() / "sumogamma_predict_small.txt";
  std::ofstream file(path);
  for (int frame = 0; frame < 30; ++frame)
    for (int agent = 1; agent <= 5; ++agent)
      file << 10 * frame << ' ' << agent << ' ' << 0.5 * frame << ' ' << 3 * agent << '\n';
  return path.string();
}

TEST(PredictCommand, ScoresARecordingAndWritesJson) {
  const auto json_path = std::filesystem::temp_directory_path() / "sumogamma_predict.json";
  const ProcessResult result = predict(
      {small_recording(), "--method", "gamma,cv", "--samples", "10", "--json", json_path.string()});
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_NE(result.output.find("constant velocity"), std::string::npos);
  const auto json = nlohmann::json::parse(std::ifstream(json_path));
  ASSERT_EQ(json.at("evaluations").size(), 2u);
  EXPECT_EQ(json["evaluations"][0]["windows"], 5 * 11);
  EXPECT_LT(json["evaluations"][0]["ade"], 0.35);
  EXPECT_NEAR(json["evaluations"][1]["ade"], 0.0, 1e-9);
  EXPECT_TRUE(json["evaluations"][0].contains("inside_90"));
}

TEST(PredictCommand, DrawsPictures) {
  const auto folder = std::filesystem::temp_directory_path() / "sumogamma_predict_plots";
  std::filesystem::remove_all(folder);
  const ProcessResult result =
      predict({small_recording(), "--method", "cv", "--plots", folder.string()});
  ASSERT_TRUE(result.ok()) << result.errors;
  ASSERT_FALSE(std::filesystem::is_empty(folder));
}

/// A file with such a content.
std::string made_file(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / ("sumogamma_predict_" + name);
  std::ofstream(path) << text;
  return path.string();
}

TEST(PredictCommand, RefusesBadRecordingsWithOneLine) {
  const std::string header = "frame,agent_id,agent_type,x_m,y_m\n";
  struct Row {
    const char* name;
    std::string text;
    const char* words;
  };
  const Row rows[] = {
      {"empty.csv", "", "no observations"},
      {"header.csv", header, "no observations"},
      {"nan.csv", header + "0,1,pedestrian,nan,0\n", ":2: x is"},
      {"twice.csv", header + "0,1,pedestrian,0,0\n0,1,pedestrian,1,0\n", "twice in frame 0"},
      {"type.csv", header + "0,1,dragon,0,0\n", "dragon"},
      {"short.txt", "0 1 0 0\n10 1 1 0\n", "20 frames"},
      {"times.txt", "0 1 0 0\n1000000000 1 0 0\n7 2 0 0\n", "counted steps"},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    const ProcessResult result = predict({made_file(row.name, row.text)});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors.rfind("sumo-gamma: ", 0), 0u) << result.errors;
    EXPECT_NE(result.errors.find(row.words), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
}

TEST(PredictCommand, TakesOneAgentAlone) {
  std::string text;
  for (int frame = 0; frame < 25; ++frame)
    text += std::to_string(10 * frame) + ".0\t1.0\t" + std::to_string(0.5 * frame) + "\t2.0\r\n";
  const ProcessResult result =
      predict({made_file("alone.txt", "\xEF\xBB\xBF" + text), "--samples", "5"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("6 windows"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("chosen without it"), std::string::npos) << result.output;
  EXPECT_EQ(result.output.find("nan"), std::string::npos) << result.output;
}

TEST(PredictCommand, RefusesBadInputWithOneLine) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"nowhere.csv"},
                                             {},
                                             {small_recording(), "--protocol", "Z"},
                                             {small_recording(), "--method", "magic"},
                                             {small_recording(), "--samples", "1"},
                                             {small_recording(), "--set", "predict.luck=1"}}) {
    const ProcessResult result = predict(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors.rfind("sumo-gamma: ", 0), 0u) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
}

}  // namespace
}  // namespace sumogamma
