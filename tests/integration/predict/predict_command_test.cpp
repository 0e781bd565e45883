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

TEST(PredictCommand, RefusesBadInputWithOneLine) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"nowhere.csv"},
                                             {},
                                             {small_recording(), "--protocol", "Z"},
                                             {small_recording(), "--method", "magic"},
                                             {small_recording(), "--set", "predict.luck=1"}}) {
    const ProcessResult result = predict(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors.rfind("sumo-gamma: ", 0), 0u) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
}

}  // namespace
}  // namespace sumogamma
