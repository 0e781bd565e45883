#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <span>

#include "base/error.h"
#include "road/sumo_net_reader.h"
#include "sumo/connect_check.h"
#include "sumo/sumo_arguments.h"
#include "sumo/sumo_process.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const CouplingScenario& scenario() {
  static const CouplingScenario instance;
  return instance;
}

ProcessResult run_words(std::vector<std::string> words) {
  ProcessRequest request;
  request.arguments = std::move(words);
  request.time_limit = 120;
  return run_process(request);
}

/// A SUMO that the user started, ready to be joined.
class UsersSumo {
 public:
  explicit UsersSumo(double step, const std::vector<std::string>& more = {},
                     const std::string& config = scenario().config()) {
    SumoArguments wish;
    wish.config = config;
    wish.step_length = step;
    wish.user = more;
    std::vector<std::string> arguments = sumo_arguments(wish);
    arguments.insert(arguments.end(), {"--remote-port", std::to_string(port_)});
    process_ = std::make_unique<SumoProcess>(find_sumo_binary("sumo"), arguments);
    wait_until_listening(port_);
  }
  std::string where() const { return "localhost:" + std::to_string(port_); }
  /// What joining it is refused with for a run of 0.05 s a step; empty: it isn't.
  std::string complaint() const {
    const ScenarioInput input = find_scenario(scenario().config());
    const RoadNetwork network = read_sumo_net(input.network);
    SumoStart start;
    start.connect_host = "localhost";
    start.connect_port = port_;
    const auto sumo = start_traci_backend(start);
    try {
      require_same_run(*sumo, {where(), &input, &network, 0.05, input.begin.value_or(0.0)});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

 private:
  int port_ = free_port();
  std::unique_ptr<SumoProcess> process_;
};

TEST(Connect, TheSameRunIsJoined) { EXPECT_EQ(UsersSumo(0.05).complaint(), ""); }

TEST(Connect, AnotherStepIsRefusedWithTheCommandThatHelps) {
  const UsersSumo sumo(1.0);
  const std::string complaint = sumo.complaint();
  EXPECT_THAT(complaint, HasSubstr(sumo.where()));
  EXPECT_THAT(complaint, HasSubstr("steps are 1"));
  EXPECT_THAT(complaint, HasSubstr("sumo -c " + scenario().config() + " --remote-port "));
  EXPECT_THAT(complaint, HasSubstr("--step-length 0.05"));
}

TEST(Connect, AnotherTimeIsRefused) {
  EXPECT_THAT(UsersSumo(0.05, {"--begin", "10"}).complaint(), HasSubstr("stands at 10 s"));
}

TEST(Connect, AnotherNetworkIsRefused) {
  const TemporaryFolder& folder = scenario().folder();
  fs::copy_file(folder.file("net.net.xml"), folder.file("other.net.xml"),
                fs::copy_options::overwrite_existing);
  scenario().write_config("other.sumocfg", "other.net.xml", "routes.rou.xml");
  EXPECT_THAT(UsersSumo(0.05, {}, folder.file("other.sumocfg")).complaint(),
              HasSubstr("other.net.xml"));
  // the same name elsewhere, and other roads
  fs::create_directories(folder.file("elsewhere"));
  const ProcessResult made =
      run_words({"netgenerate", "--spider", "-o", folder.file("elsewhere/net.net.xml")});
  ASSERT_TRUE(made.ok()) << made.errors;
  folder.write("elsewhere/none.rou.xml", "<routes/>");
  scenario().write_config("elsewhere/s.sumocfg", "net.net.xml", "none.rou.xml");
  EXPECT_THAT(UsersSumo(0.05, {}, folder.file("elsewhere/s.sumocfg")).complaint(),
              HasSubstr("another network"));
}

TEST(Connect, APortWhereNobodyListensIsSaidAtOnce) {
  SumoStart start;
  start.connect_host = "localhost";
  start.connect_port = free_port();
  const auto before = std::chrono::steady_clock::now();
  EXPECT_THROW(start_traci_backend(start), Error);
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(5));
}

// SUMO's own Python client beside us: both act, and time goes on for both
TEST(Connect, AnotherClientMayBeThere) {
  const char* home = std::getenv("SUMO_HOME");
  const fs::path tools = fs::path(home != nullptr ? home : "/usr/share/sumo") / "tools";
  if (!fs::exists(tools / "traci")) GTEST_SKIP() << "no TraCI client in " << tools;
  SumoStart start;
  SumoArguments wish;
  wish.config = scenario().config();
  wish.clients = 2;
  start.arguments = sumo_arguments(wish);
  start.clients = 2;
  start.client_order = 1;
  std::future<ProcessResult> other;
  start.on_listening = [&](int port) {
    const std::string script =
        "import sys; sys.path.insert(0, '" + tools.string() + "')\nimport traci\ntraci.init(" +
        std::to_string(port) +
        ")\ntraci.setOrder(2)\nfor _ in range(40): traci.simulationStep()\n"
        "print(traci.simulation.getTime(), traci.vehicle.getIDCount())\ntraci.close()\n";
    other = std::async(std::launch::async, [script] {
      return run_words({"python3", "-c", script});
    });
  };
  const auto sumo = start_traci_backend(start);
  SumoStep step;
  // with a ghost: what SUMO answers to our commands must not reach the other client
  const std::string id = "v0";
  for (int i = 0; i < 40; ++i) {
    const SumoPose pose{&id, {50.0 + i, 75.0}, 90.0};
    sumo->step(std::span(&pose, i > 2 ? 1u : 0u), {}, step);
    EXPECT_TRUE(step.lost.empty());
  }
  EXPECT_NEAR(step.time, 2.0, 1e-9);
  // SUMO turns to the other one only after us, or once we have gone
  sumo->close();
  const ProcessResult result = other.get();
  EXPECT_TRUE(result.ok()) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("2.0 "));
}

}  // namespace
}  // namespace sumogamma
