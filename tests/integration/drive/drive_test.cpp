// Episodes as a user drives them: the program, a real SUMO, and egos in processes of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "base/subprocess.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const fs::path kPython = fs::path(SUMOGAMMA_SOURCE_DIR) / "python";

/// Traffic on the grid of CouplingScenario.
const CouplingScenario& grid() {
  static const CouplingScenario instance;
  static const bool written = [] {
    std::string routes =
        "<routes><vType id='car' vClass='passenger' length='4.5' width='1.8' speedDev='0'/>";
    const char* ways[] = {"A0A1 A1A2 A2B2 B2C2", "C2C1 C1C0 C0B0 B0A0", "A1B1 B1C1 C1C2",
                          "C1B1 B1A1 A1A0",      "B0B1 B1B2 B2A2",      "B2B1 B1B0 B0C0"};
    for (int k = 0; k < 6; ++k)
      routes += "<flow id='f" + std::to_string(k) + "' type='car' begin='0' end='600' period='6' " +
                "departLane='random' departSpeed='5'><route edges='" + ways[k] + "'/></flow>";
    routes += "<person id='walker' depart='5'><walk edges='B0B1 B1B2'/></person>";
    routes += "<vehicle id='mine' type='car' depart='20'><route edges='A0A1 A1B1 B1C1'/></vehicle>";
    routes += "<vehicle id='late' type='car' depart='500'><route edges='A0A1 A1A2'/></vehicle>";
    routes += "</routes>";
    instance.folder().write("busy.rou.xml", routes);
    instance.write_config("busy.sumocfg", "net.net.xml", "busy.rou.xml");
    return true;
  }();
  EXPECT_TRUE(written);
  return instance;
}

class Drive : public ::testing::Test {
 protected:
  std::vector<std::string> arguments(const std::string& out,
                                     std::vector<std::string> more = {}) const {
    std::vector<std::string> all{SUMOGAMMA_PROGRAM,
                                 "drive",
                                 grid().folder().file("busy.sumocfg"),
                                 "-o",
                                 here_.file(out),
                                 "--quiet",
                                 "--set",
                                 "ego.warm_up=10",
                                 "--set",
                                 "ego.limit=30"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ProcessResult drive(const std::string& out, std::vector<std::string> more,
                      double kill_after = 0) const {
    ProcessRequest request;
    request.arguments = arguments(out, std::move(more));
    request.time_limit = 300;
    if (kill_after > 0) {
      // not even a signal handler runs
      request.arguments.insert(request.arguments.begin(),
                               {"timeout", "-s", "KILL", std::to_string(kill_after)});
    }
    return run_process(request);
  }
  /// The program waits for an ego at a socket, and `client` (words of a shell; $EGO is where)
  /// joins.
  ProcessResult drive_with(const std::string& out, std::vector<std::string> more,
                           const std::string& client, const std::string& wait = "30") const {
    const std::string address = "unix:" + here_.file("ego.sock");
    std::vector<std::string> words = arguments(out, std::move(more));
    words.insert(words.end(), {"--ego", address, "--ego-wait", wait});
    ProcessRequest request;
    request.arguments = {"sh",
                         "-c",
                         "EGO=$1; export EGO; CLIENT=$2; shift 2; (" + client +
                             ") & \"$@\"; code=$?; wait; exit $code",
                         "sh",
                         address,
                         kPython.string()};
    request.arguments.insert(request.arguments.end(), words.begin(), words.end());
    request.environment = {{"PYTHONPATH", kPython.string()}, {"PYTHONDONTWRITEBYTECODE", "1"}};
    request.time_limit = 300;
    return run_process(request);
  }
  std::string text(const std::string& out, const std::string& file) const {
    return here_.read(out + "/" + file);
  }
  /// Cells of episodes.csv by column, of the row of a seed.
  std::map<std::string, std::string> episode(const std::string& out,
                                             const std::string& seed) const {
    std::istringstream lines(text(out, "episodes.csv"));
    std::string head, line;
    std::getline(lines, head);
    std::map<std::string, std::string> cells;
    while (std::getline(lines, line)) {
      std::istringstream names(head), values(line);
      std::string name, value;
      std::map<std::string, std::string> row;
      while (std::getline(names, name, ',')) {
        value.clear();
        std::getline(values, value, ',');
        row[name] = value;
      }
      if (row["seed"] == seed) cells = row;
    }
    return cells;
  }
  void expect_same_tables(const std::string& a, const std::string& b) const {
    for (const char* file : {"episodes.csv", "plans.csv", "drive.json", "settings.json"}) {
      EXPECT_FALSE(text(a, file).empty()) << file;
      EXPECT_EQ(text(a, file), text(b, file)) << file;
    }
  }

  TemporaryFolder here_;
};

TEST_F(Drive, PairedSeedsHaveTheSameWorldUpToTheFirstAction) {
  for (const char* planner : {"gamma", "idm", "futures"}) {
    const ProcessResult result = drive(planner, {"--seeds", "1..3", "--planner", planner});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  for (const char* seed : {"1", "2", "3"}) {
    auto gamma = episode("gamma", seed), idm = episode("idm", seed),
         futures = episode("futures", seed);
    EXPECT_EQ(gamma["world_hash"], idm["world_hash"]);
    EXPECT_EQ(gamma["world_hash"], futures["world_hash"]);
    EXPECT_NE(gamma["state_hash"], idm["state_hash"]);
    EXPECT_EQ(gamma["start_x"], idm["start_x"]);
    EXPECT_GT(std::stod(gamma["progress_m"]), 5.0);
  }
  EXPECT_NE(episode("idm", "1")["world_hash"], episode("idm", "2")["world_hash"]);
  // side by side
  ProcessRequest request;
  request.arguments = {SUMOGAMMA_PROGRAM,     "report", here_.file("gamma"),    here_.file("idm"),
                       here_.file("futures"), "-o",     here_.file("page.html")};
  const ProcessResult report = run_process(request);
  ASSERT_EQ(report.exit_code, 0) << report.errors;
  EXPECT_THAT(report.output, HasSubstr("3 paired seeds"));
  EXPECT_THAT(report.output, HasSubstr("idm less gamma"));
  EXPECT_THAT(here_.read("page.html"), HasSubstr("</svg>"));
}

TEST_F(Drive, KilledTwiceAndResumedOrInTwoShardsItLeavesTheSameBytes) {
  const std::vector<std::string> what{"--seeds", "1..4", "--planner", "idm", "--threads", "1"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = what;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  ASSERT_EQ(drive("whole", what).exit_code, 0);
  EXPECT_FALSE(drive("killed", what, 0.6).ok());
  drive("killed", what, 0.9);
  ASSERT_EQ(drive("killed", what).exit_code, 0);
  expect_same_tables("whole", "killed");
  ASSERT_EQ(drive("first", with({"--shard", "1/2"})).exit_code, 0);
  ASSERT_EQ(drive("second", with({"--shard", "2/2"})).exit_code, 0);
  ASSERT_EQ(drive("merged", with({"--merge", here_.file("first"), "--merge", here_.file("second")}))
                .exit_code,
            0);
  expect_same_tables("whole", "merged");
  // and whatever the number of threads
  ASSERT_EQ(drive("threads", {"--seeds", "1..4", "--planner", "idm", "--threads", "3"}).exit_code,
            0);
  expect_same_tables("whole", "threads");
}

TEST_F(Drive, AClientThatSendsAPlannersActionsGetsItsEpisodeBitForBit) {
  ASSERT_EQ(drive("idm", {"--seeds", "2..3", "--planner", "idm"}).exit_code, 0);
  here_.write("repeat.py", R"(
import csv, os
from sumo_gamma_ego import Ego
plans = {}
for row in csv.DictReader(open(os.environ["PLANS"])):
    plans.setdefault(int(row["seed"]), []).append(float(row["acceleration"]))
with Ego(os.environ["EGO"]) as env:
    while env.seeds:
        seen, info = env.reset()
        for acceleration in plans[info["seed"]]:
            seen, reward, terminated, truncated, info = env.step(acceleration)
        assert terminated or truncated
)");
  const ProcessResult result = drive_with(
      "outside", {"--seeds", "2..3"},
      "PLANS='" + here_.file("idm/plans.csv") + "' python3 '" + here_.file("repeat.py") + "'");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* seed : {"2", "3"}) {
    EXPECT_EQ(episode("outside", seed)["state_hash"], episode("idm", seed)["state_hash"]);
    EXPECT_EQ(episode("outside", seed)["outcome"], episode("idm", seed)["outcome"]);
  }
  EXPECT_EQ(text("outside", "plans.csv"), text("idm", "plans.csv"));
}

TEST_F(Drive, TheExamplesDrive) {
  for (const char* example : {"ego_idm.py", "ego_futures.py"}) {
    SCOPED_TRACE(example);
    const ProcessResult result =
        drive_with(example, {"--seeds", "1..2"},
                   "python3 \"$CLIENT/examples/" + std::string(example) + "\" \"$EGO\"");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_THAT(result.output, HasSubstr("seed 1: "));
    EXPECT_THAT(result.output, HasSubstr("2 episodes: "));
    std::ifstream lines(kPython / "examples" / example);
    int count = 0;
    for (std::string line; std::getline(lines, line);) ++count;
    EXPECT_LE(count, 60);
  }
}

/// A client that goes so far by the book and then does something else.
struct Misbehaviour {
  const char* name;
  const char* does;  ///< Python, with `env` in an episode
  const char* complaint;
};

class BadClient : public Drive, public ::testing::WithParamInterface<Misbehaviour> {};

TEST_P(BadClient, FailsItsEpisodeAlone) {
  here_.write("bad.py", std::string(R"(
import json, os, socket, struct, time
from sumo_gamma_ego import Ego
good = Ego(os.environ["EGO"])
while len(good.seeds) > 1:
    good.reset()
    done = False
    while not done:
        _, _, terminated, truncated, _ = good.step(1.0)
        done = terminated or truncated
env = good
env.reset()
env.step(0.0)
raw = env._socket
)") + GetParam().does + "\n");
  const ProcessResult result = drive_with("out", {"--seeds", "1..2", "--ego-deadline", "0.3"},
                                          "python3 '" + here_.file("bad.py") + "' 2>/dev/null");
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr(GetParam().complaint));
  EXPECT_EQ(episode("out", "2")["outcome"], "client_failed");
  EXPECT_THAT(episode("out", "1")["outcome"], Not("client_failed"));
  EXPECT_FALSE(text("out", "drive.json").empty());
}

INSTANTIATE_TEST_SUITE_P(
    Of, BadClient,
    ::testing::Values(
        Misbehaviour{"Dies", "os._exit(1)", "went away"},
        Misbehaviour{"HalfAMessage", "raw.sendall(struct.pack('>I', 100) + b'{'); os._exit(1)",
                     "ended amid a message"},
        Misbehaviour{"AGigabyte", "raw.sendall(struct.pack('>I', 1 << 30)); time.sleep(1)",
                     "a length of 1073741824"},
        Misbehaviour{"NoLength", "raw.sendall(bytes(4)); time.sleep(1)", "a length of 0"},
        Misbehaviour{"NotANumber",
                     "body = b'{\"type\": \"step\", \"action\": {\"acceleration\": NaN}}'\n"
                     "raw.sendall(struct.pack('>I', len(body)) + body); time.sleep(1)",
                     "neither JSON nor CBOR"},
        Misbehaviour{"AStepAhead",
                     "env._ask({'type': 'step', 'step': 9, 'action': {'acceleration': 0}})",
                     "beyond the last observation's"},
        Misbehaviour{"NoMessage", "raw.sendall(struct.pack('>I', 3) + b'abc'); time.sleep(1)",
                     "neither JSON nor CBOR"},
        Misbehaviour{"SaysNothing", "time.sleep(6)", "doesn't answer any more"},
        Misbehaviour{"GivesUp", "env.reset()", "gave up amid an episode"}),
    [](const auto& one) { return one.param.name; });

TEST_F(Drive, AnotherVersionOrSilenceAtTheDoorIsRefused) {
  for (const auto& [client, complaint] :
       {std::pair{"python3 -c \"import os, sumo_gamma_ego as e; e.PROTOCOL = 7; "
                  "e.Ego(os.environ['EGO'])\" 2>/dev/null",
                  "speaks another version"},
        std::pair{"python3 -c \"import os, time, sumo_gamma_ego as e; "
                  "kept = e._connect(os.environ['EGO'], 5); time.sleep(8)\"",
                  "says nothing"},
        std::pair{"true", "nobody has joined"}}) {
    const ProcessResult result = drive_with("door", {"--seeds", "1"}, client, "3");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.errors, HasSubstr(complaint));
  }
}

TEST_F(Drive, ALateAnswerIsFullBrakingAndCounted) {
  here_.write("late.py", R"(
import os, time
from sumo_gamma_ego import Ego
with Ego(os.environ["EGO"]) as env:
    env.reset()
    done, count = False, 0
    while not done:
        count += 1
        if count == 8:
            time.sleep(1.0)
        _, _, terminated, truncated, info = env.step(2.0)
        done = terminated or truncated
    print("late", info["late"])
)");
  const ProcessResult result = drive_with("late", {"--seeds", "1", "--ego-deadline", "0.4"},
                                          "python3 '" + here_.file("late.py") + "'");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_GE(std::stoi(episode("late", "1")["late"]), 1);
  EXPECT_THAT(result.output, HasSubstr("late "));
  EXPECT_THAT(text("late", "plans.csv"), HasSubstr(",-"));
}

TEST_F(Drive, ADemandsVehicleCanBeTheEgo) {
  const ProcessResult result =
      drive("mine", {"--seeds", "1", "--vehicle", "mine", "--planner", "idm", "--set",
                     "ego.limit=90", "--set", "ego.max_speed=15"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(episode("mine", "1")["outcome"], ::testing::AnyOf("goal", "time", "collision"));
  EXPECT_GT(std::stod(episode("mine", "1")["way_m"]), 200.0);
}

TEST_F(Drive, PassesWhoHaltsInItsLane) {
  grid().folder().write(
      "halting.rou.xml",
      "<routes><vType id='car' vClass='passenger' length='4.5' width='1.8' speedDev='0'/>"
      "<vehicle id='van' type='car' depart='0' departLane='1'><route edges='A0A1 A1B1'/>"
      "<stop lane='A0A1_1' endPos='60' duration='600'/></vehicle>"
      "<vehicle id='mine' type='car' depart='20' departLane='1'><route edges='A0A1 A1B1 B1C1'/>"
      "</vehicle></routes>");
  grid().write_config("halting.sumocfg", "net.net.xml", "halting.rou.xml");
  ProcessRequest request;
  request.arguments = arguments("past", {"--seeds", "1", "--vehicle", "mine", "--planner", "idm",
                                         "--set", "ego.limit=90", "--goal-edge", "A1B1"});
  request.arguments[2] = grid().folder().file("halting.sumocfg");
  const ProcessResult result = run_process(request);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto row = episode("past", "1");
  EXPECT_EQ(row.at("outcome"), "goal");
  EXPECT_GE(std::stoi(row.at("detours")), 1);
  EXPECT_EQ(row.at("contact"), "0");
}

TEST_F(Drive, OthersMayBeSumosOwn) {
  const ProcessResult result =
      drive("none", {"--seeds", "1", "--control", "none", "--planner", "idm"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_GT(std::stoi(episode("none", "1")["others"]), 3);
}

TEST_F(Drive, AWorldWithoutRulesIsDrivenThroughToo) {
  const ProcessResult result = drive("wild", {"--seeds", "1..2", "--preset", "unregulated",
                                              "--planner", "futures", "--replay", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_FALSE(text("wild", "replay_2.html").empty());
  EXPECT_FALSE(fs::exists(here_.file("wild/replay_1.html")));
}

TEST_F(Drive, BadInputIsToldInOneLine) {
  const std::vector<std::pair<std::vector<std::string>, const char*>> wrong{
      {{"--vehicle", "nobody"}, "the demand has no 'nobody'"},
      {{"--vehicle", "walker"}, "is a person"},
      {{"--vehicle", "late", "--set", "run.duration=30"}, "hasn't departed"},
      {{"--type", "pedestrian"}, "none that drives"},
      {{"--goal-edge", "nowhere"}, "no edge 'nowhere'"},
      {{"--vehicle", "mine", "--goal-edge", "C2B2"}, "doesn't come to 'C2B2'"},
      {{"--goal-way", "1"}, "nearer than 2 m"},
      {{"--window", "-900,-900,-800,-800"}, "has no lane"},
      {{"--set", "ego.clearance=400"}, "no start with room after"},
      {{"--set", "ego.rate=50"}, "at most 20 a second"},
      {{"--set", "ego.accelerations=[0, 3]"}, "has to brake"},
      {{"--planner", "gama"}, "the nearest known one is 'gamma'"},
      {{"--planner", "idm", "--ego", "unix:x.sock"}, "leave --planner"},
      {{"--ego", "nonsense"}, "neither unix:PATH nor HOST:PORT"},
      {{"--ego", "8.8.8.8:9"}, "loopback"},
      {{"--seeds", "5..1"}, "A at most B"},
      {{"--seeds", "x"}, "no whole number"},
      {{"--replay", "7"}, "seed 7 is none of --seeds"},
      {{"--shard", "3/2"}, "from 1 to n"},
      {{"--merge", "/nowhere"}, "no folder of a drive"}};
  for (const auto& [more, complaint] : wrong) {
    SCOPED_TRACE(more.back());
    const ProcessResult result = drive("wrong", more);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(complaint));
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    std::error_code ignored;
    fs::remove_all(here_.file("wrong"), ignored);
  }
}

TEST_F(Drive, AFolderOfAnotherDriveIsRefused) {
  ASSERT_EQ(drive("one", {"--seeds", "1", "--planner", "gamma"}).exit_code, 0);
  const std::string before = text("one", "episodes.csv");
  const ProcessResult other = drive("one", {"--seeds", "1", "--planner", "idm"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.errors, HasSubstr("holds another drive: its planner is \"gamma\""));
  EXPECT_EQ(text("one", "episodes.csv"), before);
}

TEST_F(Drive, AFolderWhoseDriveCameToNothingIsFreeForTheNext) {
  ASSERT_EQ(drive("one", {"--seeds", "1", "--window", "-900,-900,-800,-800"}).exit_code, 2);
  EXPECT_EQ(drive("one", {"--seeds", "1", "--planner", "idm"}).exit_code, 0);
}

TEST_F(Drive, APageOfASeedThatIsDoneIsMadeByDrivingItAgain) {
  ASSERT_EQ(drive("one", {"--seeds", "1..2", "--planner", "idm"}).exit_code, 0);
  const std::string before = text("one", "episodes.csv");
  ASSERT_EQ(drive("one", {"--seeds", "1..2", "--planner", "idm", "--replay", "2"}).exit_code, 0);
  EXPECT_THAT(text("one", "replay_2.html"), HasSubstr("</html>"));
  EXPECT_EQ(text("one", "episodes.csv"), before);
}

/// What a page holds, as its own decoder has it.
nlohmann::json recording_of(const TemporaryFolder& folder, const std::string& page) {
  const std::string html = folder.read(page), begin = "id=\"data\">";
  const std::size_t from = html.find(begin) + begin.size();
  folder.write("data.txt", html.substr(from, html.find('<', from) - from));
  ProcessRequest request;
  request.arguments = {
      "sh",
      "-c",
      "base64 -d \"$1\" > \"$1.gz\" && node \"$2/tests/support/decode_replay.mjs\" "
      "\"$2\" \"$1.gz\"",
      "sh",
      folder.file("data.txt"),
      SUMOGAMMA_SOURCE_DIR};
  request.time_limit = 60;
  const ProcessResult result = run_process(request);
  EXPECT_TRUE(result.ok()) << result.errors;
  return nlohmann::json::parse(result.output);
}

TEST_F(Drive, APageHasItsPlansAndChangesNoEpisode) {
  if (find_program("node").empty())
    GTEST_SKIP() << "no node in PATH: the page was NOT read by its decoder";
  for (const std::string planner : {"idm", "futures", "pomdp-gamma"}) {
    SCOPED_TRACE(planner);
    const std::vector<std::string> what{"--seeds", "1", "--planner", planner};
    ASSERT_EQ(drive(planner, what).exit_code, 0);
    ASSERT_EQ(drive("shown", {"--seeds", "1", "--planner", planner, "--replay", "1"}).exit_code, 0);
    expect_same_tables(planner, "shown");
    const nlohmann::json plans = recording_of(here_, "shown/replay_1.html")["plans"];
    const std::string rows = text("shown", "plans.csv");
    EXPECT_EQ(static_cast<long>(plans.size()) + 1, std::count(rows.begin(), rows.end(), '\n'));
    std::size_t believed = 0;
    for (const nlohmann::json& plan : plans) {
      for (const nlohmann::json& ways : plan["beliefs"]) {
        double sum = 0;
        for (const nlohmann::json& way : ways) sum += way["probability"].get<double>();
        EXPECT_NEAR(sum, 1.0, 0.005);
        ++believed;
      }
      EXPECT_EQ(plan["choices"].empty(), planner == "idm");
    }
    EXPECT_EQ(believed > 0, planner != "idm");
    fs::remove_all(here_.file("shown"));
  }
}

TEST_F(Drive, WhatWasDrivenBeforeAFailureHasItsTables) {
  ASSERT_EQ(drive("one", {"--seeds", "1", "--planner", "idm"}).exit_code, 0);
  const std::string before = text("one", "episodes.csv");
  std::filesystem::remove(here_.file("one/episodes.csv"));
  const ProcessResult failed =
      drive("one", {"--seeds", "1..2", "--planner", "idm", "--sumo-options", "--no-such-option"});
  EXPECT_EQ(failed.exit_code, 2) << failed.errors;
  EXPECT_EQ(text("one", "episodes.csv"), before);
}

}  // namespace
}  // namespace sumogamma
