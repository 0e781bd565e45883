#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "base/piped_process.h"
#include "base/subprocess.h"
#include "io/output_file.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;

/// Another client, who asks SUMO for the colors of all that it shows.
constexpr const char* kAskColors = R"(
import sys
sys.path.append('/usr/share/sumo/tools')
import traci
traci.init(port=int(sys.argv[1]), numRetries=60)
traci.setOrder(2)
colors = set()
for _ in range(70):
    traci.simulationStep()
    colors |= {traci.vehicle.getColor(id) for id in traci.vehicle.getIDList()}
print(sorted(colors))
traci.close()
)";

TEST(Window, IsPacedAndPaintedByWhatBinds) {
  for (const char* const needed : {"Xvfb", "sumo-gui", "python3"})
    if (find_program(needed).empty())
      GTEST_SKIP() << "no " << needed << " in PATH: the window was NOT looked at";
  const fs::path folder =
      fs::temp_directory_path() / ("sumogamma_window_" + std::to_string(getpid()));
  fs::create_directories(folder);
  PipedProcess screen(
      {{"Xvfb", "-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp"},
       0,
       1,
       folder / "xvfb.log"});
  const std::string display = ":" + screen.read_until('\n');
  const std::string port = std::to_string(20000 + getpid() % 20000);
  ProcessRequest request;
  request.environment = {{"DISPLAY", display}};
  request.time_limit = 120;
  request.arguments = {SUMOGAMMA_PROGRAM,
                       "run",
                       SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/signalled_crossing",
                       "-o",
                       (folder / "out").string(),
                       "--gui",
                       "--duration",
                       "4",
                       "--num-clients",
                       "2",
                       "--remote-port",
                       port,
                       "--quiet"};
  ProcessResult run;
  std::thread other([&] { run = run_process(request); });
  ProcessRequest client;
  client.arguments = {"python3", "-c", kAskColors, port};
  client.time_limit = 120;
  const ProcessResult colors = run_process(client);
  other.join();
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  ASSERT_EQ(colors.exit_code, 0) << colors.errors;
  // free, behind somebody, or before a red light
  EXPECT_THAT(colors.output,
              AnyOf(HasSubstr("(223, 229, 234, 255)"), HasSubstr("(86, 180, 233, 255)"),
                    HasSubstr("(213, 94, 0, 255)")));
  const auto results = nlohmann::json::parse(read_file(folder / "out" / "results.json"));
  EXPECT_GT(results["timing"]["wall_s"].get<double>(), 3.5) << "no faster than the clock";
  request.arguments = {SUMOGAMMA_PROGRAM,
                       "run",
                       SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/signalled_crossing",
                       "-o",
                       (folder / "bad").string(),
                       "--gui",
                       "--sumo-options",
                       "--delay soon"};
  const ProcessResult bad = run_process(request);
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.errors, HasSubstr("--delay soon"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace sumogamma
