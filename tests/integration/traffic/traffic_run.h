#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "support/coupling_scenario.h"

namespace sumogamma {

/// What tools/measure_traffic.py says of a run folder of the scenario; fails the test where it
/// can't read it.
inline nlohmann::json measured(const std::string& scenario, const std::string& folder) {
  ProcessRequest request;
  request.arguments = {"python3", "-B", SUMOGAMMA_SOURCE_DIR "/tools/measure_traffic.py", scenario,
                       folder};
  request.time_limit = 120.0;
  const ProcessResult result = run_process(request);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  nlohmann::json figures = nlohmann::json::parse(result.output, nullptr, false);
  EXPECT_FALSE(figures.is_discarded()) << result.output;
  return figures;
}

/// Runs sumo_scenarios/NAME without a window into the folder's "out", with `options` of `run`.
inline void run_scenario(const std::string& scenario, const std::vector<std::string>& options,
                         const TemporaryFolder& folder) {
  ProcessRequest request;
  request.arguments = {
      SUMOGAMMA_PROGRAM,
      "run",
      SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/" + scenario + "/" + scenario + ".sumocfg",
      "-o",
      folder.file("out"),
      "--quiet"};
  request.arguments.insert(request.arguments.end(), options.begin(), options.end());
  request.time_limit = 300.0;
  const ProcessResult result = run_process(request);
  EXPECT_EQ(result.exit_code, 0) << describe_end(result, 300) << "\n" << result.errors;
}

/// Runs sumo_scenarios/NAME and returns its figures.
inline nlohmann::json figures_of(const std::string& scenario, const std::string& seed) {
  const TemporaryFolder folder;
  run_scenario(scenario, {"--trajectory-period", "0.1", "--seed", seed}, folder);
  return measured(scenario, folder.file("out"));
}

}  // namespace sumogamma
