// sumo-gamma validate: the command, its files and its exit codes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

using nlohmann::json;

ProcessResult validate(const TemporaryFolder& folder, std::vector<std::string> options) {
  ProcessRequest request;
  request.arguments = {SUMOGAMMA_PROGRAM, "validate", "-o", folder.file("out")};
  request.arguments.insert(request.arguments.end(), options.begin(), options.end());
  request.time_limit = 300;
  return run_process(request);
}

TEST(Validate, WalksTheCasesThatAreAskedFor) {
  const TemporaryFolder folder;
  const ProcessResult result = validate(folder, {"--only", "R1,R6", "--fast", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.output << result.errors;
  EXPECT_EQ(result.errors, "");
  const json outcomes = json::parse(folder.read("out/validate.json"))["outcomes"];
  ASSERT_EQ(outcomes.size(), 3u);
  EXPECT_EQ(outcomes[0]["id"], "R1");
  EXPECT_NEAR(outcomes[0]["mean"].get<double>(), 40.0 / 1.33, 1.0);
  EXPECT_EQ(outcomes[0]["values"].size(), 2u);
  EXPECT_EQ(outcomes[1]["verdict"], "PASS");
  EXPECT_NE(folder.read("out/validate.html").find("Is a corner walked round"), std::string::npos);
}

TEST(Validate, DrivesASmallScenarioAndSumoBesideIt) {
  const TemporaryFolder folder;
  const ProcessResult result = validate(folder, {"--only", "V5", "--seeds", "1", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.output << result.errors;
  for (const json& outcome : json::parse(folder.read("out/validate.json"))["outcomes"]) {
    EXPECT_EQ(outcome["verdict"], "PASS") << outcome;
    EXPECT_TRUE(outcome["sumo_mean"].is_number()) << outcome;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("out/run"))) << "what it was measured from";
}

TEST(Validate, SaysWhichTrialsThereAre) {
  const TemporaryFolder folder;
  const ProcessResult result = validate(folder, {"--only", "R99"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("--only R99: is no trial; there are V1,"), std::string::npos)
      << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder.file("out")));
}

TEST(Validate, SaysWhereItsScenariosAreMissing) {
  const TemporaryFolder folder;
  const ProcessResult result = validate(folder, {"--only", "V5", "--data", folder.file("")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("finds no folder with sumo_scenarios"), std::string::npos)
      << result.errors;
}

}  // namespace
}  // namespace sumogamma
