// A real SUMO as our child that dies, hangs or never comes up.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "base/error.h"
#include "sumo/backend.h"
#include "sumo/sumo_arguments.h"
#include "sumo/sumo_process.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

const CouplingScenario& scenario() {
  static const CouplingScenario instance;
  return instance;
}

SumoStart request(const std::string& binary = "sumo") {
  SumoArguments wish;
  wish.config = scenario().config();
  SumoStart start;
  start.binary = binary;
  start.arguments = sumo_arguments(wish);
  start.start_timeout = 20;
  start.step_timeout = 2;
  return start;
}

std::vector<pid_t> children() {
  std::ifstream list("/proc/self/task/" + std::to_string(getpid()) + "/children");
  std::vector<pid_t> pids;
  for (pid_t pid = 0; list >> pid;) pids.push_back(pid);
  return pids;
}

std::string step_error(SumoBackend& sumo) {
  SumoStep step;
  try {
    for (int i = 0; i < 50; ++i) sumo.step({}, {}, step);
  } catch (const SumoError& error) {
    return error.what();
  }
  return "no error";
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string script(const std::string& name, const std::string& body) {
  scenario().folder().write(name, "#!/bin/sh\n" + body);
  const std::string path = scenario().folder().file(name);
  chmod(path.c_str(), 0755);
  return path;
}

TEST(Faults, KilledInMidRunIsASumoErrorAndLeavesNoZombie) {
  const auto sumo = start_traci_backend(request());
  SumoStep step;
  for (int i = 0; i < 20; ++i) sumo->step({}, {}, step);
  const std::vector<pid_t> before = children();
  ASSERT_EQ(before.size(), 1u);
  kill(before[0], SIGKILL);
  const auto begin = std::chrono::steady_clock::now();
  const std::string words = step_error(*sumo);
  EXPECT_NE(words.find("signal 9"), std::string::npos) << words;
  EXPECT_NE(words.find("1.0"), std::string::npos) << "when: " << words;
  EXPECT_LT(seconds_since(begin), 2);
  EXPECT_TRUE(children().empty());
  EXPECT_THROW(sumo->step({}, {}, step), SumoError);
  EXPECT_THROW(sumo->finish_stage("walker"), SumoError);
  sumo->close();
}

TEST(Faults, KilledBetweenStartAndFirstStepIsNotTheUsersFault) {
  const auto sumo = start_traci_backend(request());
  kill(children().at(0), SIGKILL);
  EXPECT_NE(step_error(*sumo).find("signal 9"), std::string::npos);
}

TEST(Faults, AbortTellsTheAssertion) {
  const auto sumo = start_traci_backend(request());
  SumoStep step;
  sumo->step({}, {}, step);
  kill(children().at(0), SIGABRT);
  EXPECT_NE(step_error(*sumo).find("signal 6"), std::string::npos);
}

TEST(Faults, AHungSumoIsGivenUpAndKilled) {
  const auto sumo = start_traci_backend(request());
  SumoStep step;
  sumo->step({}, {}, step);
  const pid_t pid = children().at(0);
  kill(pid, SIGSTOP);
  const auto begin = std::chrono::steady_clock::now();
  const std::string words = step_error(*sumo);
  EXPECT_NE(words.find("time limit"), std::string::npos) << words;
  EXPECT_LT(seconds_since(begin), 10);
  EXPECT_TRUE(children().empty());
}

TEST(Faults, ClosingAHungSumoEnds) {
  SumoStart start = request();
  const auto sumo = start_traci_backend(start);
  SumoStep step;
  sumo->step({}, {}, step);
  kill(children().at(0), SIGKILL);
  sumo->close();
  EXPECT_TRUE(children().empty());
}

TEST(Faults, ABinaryThatNeverListensIsGivenUp) {
  SumoStart start = request(script("sleeper", "exec sleep 1000\n"));
  start.start_timeout = 0.5;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(start_traci_backend(start), SumoError);
  EXPECT_LT(seconds_since(begin), 10);
  EXPECT_TRUE(children().empty());
}

TEST(Faults, ASlowStartIsWaitedFor) {
  const auto sumo = start_traci_backend(request(script("slow", "sleep 1\nexec sumo \"$@\"\n")));
  SumoStep step;
  sumo->step({}, {}, step);
  EXPECT_GT(step.time, 0);
}

// a large network takes longer than any limit: who computes isn't given up
TEST(Faults, AStartThatComputesIsWaitedForBeyondTheLimit) {
  SumoStart start = request(
      script("busy", "i=0\nwhile [ $i -lt 2000000 ]; do i=$((i+1)); done\nexec sumo \"$@\"\n"));
  start.start_timeout = 0.4;
  const auto begin = std::chrono::steady_clock::now();
  const auto sumo = start_traci_backend(start);
  EXPECT_GT(seconds_since(begin), start.start_timeout)
      << "the script is too quick to test anything";
  SumoStep step;
  sumo->step({}, {}, step);
  EXPECT_GT(step.time, 0);
}

TEST(Faults, ATakenPortIsReplacedByAnother) {
  const std::string tries = scenario().folder().file("tries");
  const auto sumo = start_traci_backend(
      request(script("taken", "echo x >> '" + tries + "'\nif [ $(wc -l < '" + tries +
                                  "') -lt 3 ]; then echo 'Error: tcpip::Socket::accept() Unable to "
                                  "create listening socket: Address "
                                  "already in use' >&2; exit 1; fi\nexec sumo \"$@\"\n")));
  SumoStep step;
  sumo->step({}, {}, step);
  EXPECT_EQ(scenario().folder().read("tries"), "x\nx\nx\n");
}

TEST(Faults, AFloodOfMessagesDoesNotBlockSumo) {
  const auto sumo = start_traci_backend(request(script(
      "flood",
      "(i=0; while [ $i -lt 20000 ]; do echo 'Warning: a long line of nothing at all'; i=$((i+1)); "
      "done) &\nexec sumo \"$@\"\n")));
  SumoStep step;
  for (int i = 0; i < 50; ++i) sumo->step({}, {}, step);
  EXPECT_LE(sumo->take_warnings().size(), 12u);
  EXPECT_GT(sumo->sumo_warnings(), 0);
}

TEST(Faults, NoBinary) { EXPECT_THROW(start_traci_backend(request("no-such-sumo")), Error); }

// --connect: a SUMO that the user started
TEST(Faults, JoinsASumoOfTheUsers) {
  const int port = free_port();
  SumoArguments wish;
  wish.config = scenario().config();
  std::vector<std::string> arguments = sumo_arguments(wish);
  arguments.insert(arguments.end(), {"--remote-port", std::to_string(port)});
  SumoProcess users(find_sumo_binary("sumo"), arguments);
  wait_until_listening(port);
  SumoStart start;
  start.connect_host = "localhost";
  start.connect_port = port;
  {
    const auto sumo = start_traci_backend(start);
    SumoStep step;
    for (int i = 0; i < 10; ++i) sumo->step({}, {}, step);
    EXPECT_NEAR(step.time, 0.5, 1e-9);
    EXPECT_NE(sumo->option("net-file").find("net.net.xml"), std::string::npos);
    EXPECT_TRUE(users.running());
    sumo->close();
  }
  EXPECT_TRUE(users.wait(10));
  EXPECT_EQ(users.exit_code(), 0) << users.output().tail();
}

TEST(Faults, LibsumoCanNotJoinNorShowAWindow) {
  SumoStart start = request();
  start.connect_host = "localhost";
  EXPECT_THROW(start_libsumo_backend(start), Error);
  EXPECT_THROW(start_libsumo_backend(request("sumo-gui")), Error);
}

TEST(Faults, LibsumoHoldsOneSimulation) {
  const auto first = start_libsumo_backend(request());
  EXPECT_THROW(start_libsumo_backend(request()), SumoError);
  first->close();
  EXPECT_NO_THROW(start_libsumo_backend(request()));
}

// the socket and the in-process back end side by side, and to the last bit the same
TEST(Faults, BothBackEndsMakeTheSameRun) {
  const auto socket = start_traci_backend(request());
  const auto inside = start_libsumo_backend(request());
  SumoStep one, other;
  for (int i = 0; i < 600; ++i) {
    socket->step({}, {}, one);
    inside->step({}, {}, other);
    for (const std::string& id : one.departed_vehicles) {
      socket->watch(id, false);
      inside->watch(id, false);
    }
    ASSERT_EQ(one.departed_vehicles, other.departed_vehicles);
    ASSERT_EQ(one.arrived_persons, other.arrived_persons);
    ASSERT_EQ(one.signal_states, other.signal_states);
    ASSERT_EQ(one.agents.size(), other.agents.size());
    for (std::size_t k = 0; k < one.agents.size(); ++k) {
      ASSERT_EQ(one.agents[k].position, other.agents[k].position) << "step " << i;
      ASSERT_EQ(one.agents[k].angle, other.agents[k].angle);
      ASSERT_EQ(one.agents[k].speed, other.agents[k].speed);
    }
  }
}

}  // namespace
}  // namespace sumogamma
