#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/subprocess.h"
#include "road/sumo_net_reader.h"

extern char** environ;

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

const fs::path kFixtures = fs::path(SUMOGAMMA_SOURCE_DIR) / "tests/support/osm";
const fs::path kMaps = fs::path(SUMOGAMMA_SOURCE_DIR) / "osm_maps";

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Text of a gzipped file; fails the test where the file is cut off or damaged.
std::string unzipped(const fs::path& file) {
  gzFile stream = gzopen(file.c_str(), "rb");
  if (stream == nullptr) {
    ADD_FAILURE() << file << " can't be opened";
    return "";
  }
  std::string text;
  char buffer[1 << 14];
  int got = 0;
  while ((got = gzread(stream, buffer, sizeof buffer)) > 0)
    text.append(buffer, static_cast<std::size_t>(got));
  int code = 0;
  gzerror(stream, &code);
  EXPECT_TRUE(code == Z_OK || code == Z_STREAM_END) << file << " is damaged";
  EXPECT_EQ(gzclose_r(stream), Z_OK) << file << " is cut off";
  return text;
}

class RunTest : public ::testing::Test {
 protected:
  RunTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("sumogamma_run_" + std::to_string(getpid()) + "_" + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~RunTest() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  ProcessResult program(std::vector<std::string> arguments) const {
    ProcessRequest request;
    request.arguments = std::move(arguments);
    request.arguments.insert(request.arguments.begin(), SUMOGAMMA_PROGRAM);
    request.time_limit = 300.0;
    return run_process(request);
  }
  void import(const fs::path& map, const std::string& agents) const {
    const ProcessResult made = program({"import", map.string(), "-o", scenario(), "--agents",
                                        agents, "--duration", "300", "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.errors;
  }
  std::string scenario() const { return (folder_ / "scenario").string(); }
  fs::path out(const std::string& name = "out") const { return folder_ / name; }

  ProcessResult run(const std::string& what, const std::string& output,
                    std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"run", what, "-o", out(output).string(), "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return program(arguments);
  }
  /// Runs the imported scenario and returns results.json.
  json results_of(const std::string& output, std::vector<std::string> more) const {
    const ProcessResult result = run(scenario(), output, std::move(more));
    EXPECT_EQ(result.exit_code, 0) << describe_end(result, 300) << "\n" << result.errors;
    return results_in(output);
  }
  json results_in(const std::string& output) const {
    const json results = json::parse(content(out(output) / "results.json"), nullptr, false);
    EXPECT_FALSE(results.is_discarded()) << "no results.json in " << output;
    if (!results.is_discarded()) {
      EXPECT_TRUE(results["agents"]["removed"].empty()) << results["agents"]["removed"];
      EXPECT_EQ(results["coupling"]["teleports"], 0);
    }
    return results;
  }
  /// Everything that a run leaves is there and whole.
  void expect_whole_outputs(const std::string& output) const {
    EXPECT_THAT(unzipped(out(output) / "trajectories.fcd.xml.gz"), HasSubstr("</fcd-export>"));
    EXPECT_THAT(content(out(output) / "replay.html"), HasSubstr("</html>"));
    EXPECT_GT(fs::file_size(out(output) / "replay.bin"), 0u);
    EXPECT_THAT(content(out(output) / "stuck.csv"), HasSubstr("agent,type"));
    EXPECT_THAT(content(out(output) / "held.csv"), HasSubstr("agent,type"));
    EXPECT_THAT(content(out(output) / "trips.csv"), HasSubstr("agent,type,departed_s"));
    EXPECT_THAT(content(out(output) / "offences.csv"), HasSubstr("agent,type"));
    EXPECT_THAT(content(out(output) / "collisions.csv"), HasSubstr("agent,type,other"));
  }
  /// Exit code 2 and one line that says what is wrong; no output folder.
  void expect_refused(const ProcessResult& result, const std::string& words) const {
    EXPECT_EQ(result.exit_code, 2) << describe_end(result, 300) << "\n" << result.errors;
    EXPECT_EQ(result.signal, 0);
    EXPECT_EQ(result.errors.find("sumo-gamma: "), 0u) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(words));
    EXPECT_FALSE(fs::exists(out())) << "an output folder was left behind";
  }

  fs::path folder_;
};

void expect_keys(const json& object, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << key << " is missing";
}

TEST_F(RunTest, EveryKeyOfTheResultsIsThere) {
  import(kFixtures / "signalled_crossing_right.osm", "20");
  const json results = results_of("out", {"--duration", "20", "--replay"});
  expect_keys(results,
              {"sumo_version", "sumo_gamma_version", "scenario", "seed", "step", "duration",
               "clock", "not_followed", "backend", "threads", "agents", "timing", "collisions",
               "flow", "rules", "smoothness", "coupling", "prediction", "state_hash"});
  expect_keys(results["agents"],
              {"inserted", "arrived", "removed", "controlled_now", "controlled_peak",
               "controlled_mean", "by_type", "stops_served", "rides", "left_to_sumo"});
  expect_keys(results["timing"],
              {"wall_s", "real_time_factor", "cpu_s", "share", "model_cpu_us_per_agent_step"});
  expect_keys(results["timing"]["share"],
              {"observe", "context", "model", "track", "advance_sumo", "record"});
  expect_keys(results["collisions"],
              {"unique_pairs", "unique_pairs_per_agent_hour", "overlap_share_of_agent_steps",
               "deep_pairs", "by_types", "worst_penetration_m"});
  expect_keys(results["flow"], {"mean_speed", "distance_km", "stuck_agents", "longest_standstill_s",
                                "held_agents", "longest_held_s", "waiting_time_mean_s"});
  expect_keys(results["rules"], {"red_light_crossings", "wrong_way_s", "overtaking_s", "off_road_s",
                                 "sidewalk_by_vehicle_s", "by_types"});
  expect_keys(results["smoothness"],
              {"accel_p95", "jerk_p95", "yaw_rate_p95", "lateral_slip_p95", "reversals"});
  expect_keys(results["coupling"],
              {"position_error_max_m", "position_error_p99_m", "lane_mismatches", "teleports",
               "emergency_stops", "sumo_warnings"});
  EXPECT_EQ(results["duration"], 20.0);
  EXPECT_EQ(results["seed"], 1);
  EXPECT_EQ(results["backend"], "traci");
  EXPECT_GT(results["agents"]["inserted"], 5);
  EXPECT_GT(results["flow"]["distance_km"], 0.1);
  EXPECT_LE(results["coupling"]["position_error_max_m"], 1e-6);
  for (const auto& [type, counts] : results["agents"]["by_type"].items())
    expect_keys(counts, {"inserted", "arrived"});
  expect_whole_outputs("out");
}

TEST_F(RunTest, PredictsWhoeverDrivesAndScoresIt) {
  import(kFixtures / "signalled_crossing_right.osm", "20");
  for (const std::string control : {"none", "all"}) {
    const json plain = results_of("plain_" + control, {"--duration", "40", "--control", control});
    EXPECT_EQ(plain["prediction"]["asked"], false);
    EXPECT_EQ(plain["prediction"]["predictions"], 0);
    const json results =
        results_of(control, {"--duration", "40", "--control", control, "--predict"});
    const json& prediction = results["prediction"];
    EXPECT_EQ(prediction["asked"], true);
    EXPECT_GT(prediction["predictions"], 200);
    EXPECT_GT(prediction["ade_m"], 0.0);
    EXPECT_GT(prediction["fde_m"], prediction["ade_m"]);
    // whoever looks at what the road says foresees more than constant velocity
    EXPECT_LT(prediction["ade_m"], prediction["constant_velocity_ade_m"]);
    long sum = 0;
    for (const auto& [type, score] : prediction["by_type"].items())
      sum += score["predictions"].get<long>();
    EXPECT_EQ(sum, prediction["predictions"]);
    // looking changes nothing
    EXPECT_EQ(results["state_hash"], plain["state_hash"]);
  }
}

TEST_F(RunTest, TheSameStateWhateverTheThreadsTheBackEndAndTheRun) {
  import(kMaps / "fujisawa.osm.pbf", "60");
  const json first = results_of("first", {"--duration", "20"});
  const json again = results_of("again", {"--duration", "20"});
  const json threads = results_of("threads", {"--duration", "20", "--threads", "2"});
  const json in_process = results_of("libsumo", {"--duration", "20", "--backend", "libsumo"});
  const json seeded = results_of("seeded", {"--duration", "20", "--seed", "2"});
  EXPECT_GT(first["agents"]["inserted"], 20);
  EXPECT_EQ(first["state_hash"], again["state_hash"]);
  EXPECT_EQ(first["state_hash"], threads["state_hash"]);
  EXPECT_EQ(first["state_hash"], in_process["state_hash"]);
  EXPECT_NE(first["state_hash"], seeded["state_hash"]);
  EXPECT_EQ(unzipped(out("first") / "trajectories.fcd.xml.gz"),
            unzipped(out("threads") / "trajectories.fcd.xml.gz"));
  EXPECT_EQ(in_process["backend"], "libsumo");
  EXPECT_EQ(threads["threads"], 2);
}

TEST_F(RunTest, AsManyAsAskedForAreAlive) {
  import(kMaps / "monaco.osm.pbf", "60");
  // 23 % of the demand walk: of 20 alive 15 are vehicles, a tenth more at the most, whoever drives
  for (const std::string control : {"all", "none"}) {
    const json run =
        results_of(control, {"--agents", "20", "--duration", "40", "--control", control});
    int vehicles = 0;
    for (const auto& [type, counts] : run["agents"]["by_type"].items())
      if (type != "pedestrian")
        vehicles += counts["inserted"].get<int>() - counts["arrived"].get<int>();
    EXPECT_LE(vehicles, 17) << control;
    EXPECT_GE(vehicles, 15) << control;
  }
}

TEST_F(RunTest, WhoIsDrivenIsAChoice) {
  import(kMaps / "monaco.osm.pbf", "60");
  const json all = results_of("all", {"--duration", "20"});
  // all of them but those who had arrived before the last came
  EXPECT_LE(all["agents"]["controlled_peak"], all["agents"]["inserted"]);
  EXPECT_GE(all["agents"]["controlled_peak"].get<int>() + all["agents"]["arrived"].get<int>(),
            all["agents"]["inserted"].get<int>());

  const json none = results_of("none", {"--duration", "20", "--control", "none"});
  EXPECT_EQ(none["agents"]["controlled_peak"], 0);
  EXPECT_GT(none["agents"]["inserted"], 20);
  EXPECT_GT(none["flow"]["distance_km"], 0.1);

  const json some = results_of("some", {"--duration", "20", "--control", "car,bus"});
  const auto driven = some["agents"]["by_type"]["car"]["inserted"].get<int>() +
                      some["agents"]["by_type"]["bus"]["inserted"].get<int>();
  const auto arrived = some["agents"]["by_type"]["car"]["arrived"].get<int>() +
                       some["agents"]["by_type"]["bus"]["arrived"].get<int>();
  EXPECT_LE(some["agents"]["controlled_peak"], driven);
  EXPECT_GE(some["agents"]["controlled_peak"].get<int>() + arrived, driven);
  EXPECT_GT(some["agents"]["inserted"], driven);

  const json one = results_of("one", {"--duration", "20", "--control", "car.0"});
  EXPECT_EQ(one["agents"]["controlled_peak"], 1);
}

TEST_F(RunTest, ARegionTakesOverWhoEntersIt) {
  import(kMaps / "monaco.osm.pbf", "60");
  const RoadNetwork network = read_sumo_net(fs::path(scenario()) / "net.net.xml");
  const Vec2 low = network.lower_corner, high = network.upper_corner;
  auto box = [](const Vec2& a, const Vec2& b) {
    return std::to_string(a.x()) + "," + std::to_string(a.y()) + "," + std::to_string(b.x()) + "," +
           std::to_string(b.y());
  };
  const Vec2 middle = 0.5 * (low + high);
  const json half = results_of(
      "half", {"--duration", "30", "--region=" + box({low.x(), low.y()}, {middle.x(), high.y()})});
  EXPECT_GT(half["agents"]["controlled_peak"], 0);
  EXPECT_LT(half["agents"]["controlled_peak"], half["agents"]["inserted"]);
  const json nowhere = results_of(
      "nowhere",
      {"--duration", "10", "--region=" + box(high + Vec2(500, 500), high + Vec2(600, 600))});
  EXPECT_EQ(nowhere["agents"]["controlled_peak"], 0);
}

class UserConfigTest : public RunTest {
 protected:
  void SetUp() override {
    import(kFixtures / "two_way_stop_right.osm", "10");
    fs::create_directories(folder_ / "own");
    for (const char* file : {"net.net.xml", "demand.rou.xml"})
      fs::copy_file(fs::path(scenario()) / file, folder_ / "own" / file);
  }
  std::string config(const std::string& body) const {
    const fs::path file = folder_ / "own" / "mine.sumocfg";
    std::ofstream(file) << "<configuration>" << body << "</configuration>";
    return file.string();
  }
  std::string config(const std::string& net, const std::string& routes) const {
    return config("<input><net-file value=\"" + net + "\"/><route-files value=\"" + routes +
                  "\"/></input>");
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / "own" / name) << text;
  }
};

TEST_F(UserConfigTest, RunsWithoutSettingsBesideIt) {
  const ProcessResult result =
      run(config("net.net.xml", "demand.rou.xml"), "out", {"--duration", "15"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json results = results_in("out");
  EXPECT_EQ(results["scenario"], "mine");
  EXPECT_GT(results["agents"]["inserted"], 0);
}

TEST_F(UserConfigTest, LastsAsLongAsItSays) {
  const std::string file = config(
      "<input><net-file value=\"net.net.xml\"/><route-files value=\"demand.rou.xml\"/></input>"
      "<time><begin value=\"3\"/><end value=\"10\"/></time>");
  ASSERT_EQ(run(file, "out", {}).exit_code, 0);
  EXPECT_NEAR(results_in("out")["duration"].get<double>(), 7.0, 1e-9);
  ASSERT_EQ(run(file, "shorter", {"--duration", "4"}).exit_code, 0);
  EXPECT_NEAR(results_in("shorter")["duration"].get<double>(), 4.0, 1e-9);
}

TEST_F(UserConfigTest, OptionsMayHaveTheirOtherNames) {
  const ProcessResult result =
      run(config("<n v=\"net.net.xml\"/><r v=\"demand.rou.xml\"/>"), "out", {"--duration", "5"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

TEST_F(UserConfigTest, ItsClockHoldsAndTheResultsSayWhoSaidWhat) {
  const std::string file = config(
      "<n v=\"net.net.xml\"/><r v=\"demand.rou.xml\"/><b v=\"0:00:03\"/><e v=\"0:00:05\"/>"
      "<step-length v=\"0.1\"/><seed v=\"42\"/>");
  ASSERT_EQ(run(file, "own", {}).exit_code, 0);
  json clock = results_in("own")["clock"];
  EXPECT_EQ(clock["begin"], 3.0);
  EXPECT_EQ(clock["end"], 5.0);
  EXPECT_EQ(clock["step"], 0.1);
  EXPECT_EQ(clock["seed"], 42);
  for (const char* key : {"begin", "end", "step", "seed"})
    EXPECT_EQ(clock["from"][key], "configuration") << key;
  ASSERT_EQ(run(file, "told", {"--duration", "0:00:01", "--step", "0.05", "--seed", "7"}).exit_code,
            0);
  clock = results_in("told")["clock"];
  EXPECT_EQ(clock["end"], 4.0);
  EXPECT_EQ(clock["step"], 0.05);
  EXPECT_EQ(clock["seed"], 7);
  for (const char* key : {"end", "step", "seed"})
    EXPECT_EQ(clock["from"][key], "command line") << key;
  // SUMO's default of a second is too long for us
  const std::string slow =
      config("<n v=\"net.net.xml\"/><r v=\"demand.rou.xml\"/><e v=\"2\"/><step-length v=\"1\"/>");
  ASSERT_EQ(run(slow, "slow", {}).exit_code, 0);
  EXPECT_EQ(results_in("slow")["clock"]["step"], 0.05);
  EXPECT_EQ(results_in("slow")["clock"]["from"]["step"], "default");
}

TEST_F(UserConfigTest, WhatIsNotFollowedIsSaid) {
  const RoadNetwork road = read_sumo_net(folder_ / "own" / "net.net.xml");
  const auto drivable = std::find_if(road.edges.begin(), road.edges.end(), [&](const Edge& one) {
    return one.kind == LaneKind::Normal && allows(road, one, vehicle_class::kPassenger);
  });
  ASSERT_NE(drivable, road.edges.end());
  const std::string edge = drivable->name;
  put("x.add.xml", "<whatever><calibrator id=\"c\" edge=\"" + edge +
                       "\" pos=\"0\"><flow begin=\"0\" end=\"9\" speed=\"9\" "
                       "route=\"r\"/></calibrator><route id=\"r\" edges=\"" +
                       edge + "\"/></whatever>");
  const std::string file =
      config("<n v=\"net.net.xml\"/><r v=\"demand.rou.xml\"/><a v=\"x.add.xml\"/><e v=\"2\"/>");
  const ProcessResult result = run(file, "out", {});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("calibrator c in x.add.xml: not followed"));
  const json said = results_in("out")["not_followed"];
  ASSERT_EQ(said.size(), 1u) << said;
  EXPECT_EQ(said[0]["what"], "calibrator");
  EXPECT_EQ(said[0]["file"], "x.add.xml");
  const ProcessResult plain = run(file, "plain", {"--control", "none"});
  EXPECT_EQ(plain.exit_code, 0) << plain.errors;
  EXPECT_TRUE(results_in("plain")["not_followed"].empty());
}

// names that a shell would act on: one that ran would leave a file behind
TEST_F(UserConfigTest, NamesNeverReachAShell) {
  const std::string mark = "touched";
  const std::string hostile = "x;touch " + mark + ";$(touch " + mark + ")`touch " + mark + "`";
  std::string routes = content(folder_ / "own" / "demand.rou.xml");
  // SUMO refuses ids with blanks and quotes by itself
  routes.insert(routes.find("<vehicle id=\"") + 13, "$(touch${IFS}" + mark + ")");
  put("demand.rou.xml", routes);
  const fs::path folder = folder_ / ("own " + hostile);
  fs::copy(folder_ / "own", folder);
  const std::string file = (folder / "mine.sumocfg").string();
  std::ofstream(file) << "<configuration><input><net-file value=\"net.net.xml\"/><route-files "
                         "value=\"demand.rou.xml\"/></input></configuration>";
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  const ProcessResult result = run(file, "out " + hostile, {"--duration", "20", "--replay"});
  const ProcessResult options = run(file, "second",
                                    {"--duration", "5", "--sumo-options",
                                     "--tripinfo-output '" + mark + "2;touch " + mark + "'"});
  const ProcessResult imported =
      program({"import", hostile, "-o", (folder_ / hostile).string(), "--quiet"});
  fs::current_path(before);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(options.exit_code, 0) << options.errors;
  EXPECT_EQ(imported.exit_code, 2) << imported.errors;
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    EXPECT_NE(entry.path().filename(), mark) << entry.path();
}

// a few lines that would become gigabytes, and a file of somebody else's
TEST_F(UserConfigTest, XmlEntitiesAreRefused) {
  const std::string bomb =
      "<!DOCTYPE r [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">"
      "<!ENTITY c SYSTEM \"file:///etc/passwd\">]>";
  const std::string input =
      "<input><net-file value=\"net.net.xml\"/><route-files "
      "value=\"demand.rou.xml\"/></input>";
  for (const char* name : {"net.net.xml", "demand.rou.xml"}) {
    const std::string whole = content(folder_ / "own" / name);
    std::string changed = whole;
    const std::size_t head = changed.find("?>");
    changed.insert(head == std::string::npos ? 0 : head + 2, bomb);
    put(name, changed);
    expect_refused(run(config(input), "out", {"--duration", "5"}), "declares XML entities");
    put(name, whole);
  }
  std::ofstream(folder_ / "own" / "mine.sumocfg")
      << bomb << "<configuration>" << input << "</configuration>";
  expect_refused(run((folder_ / "own" / "mine.sumocfg").string(), "out", {"--duration", "5"}),
                 "declares XML entities");
}

TEST_F(UserConfigTest, FoldersMayHaveCommasAndBlanks) {
  fs::rename(folder_ / "own", folder_ / "my own, really");
  const fs::path file = folder_ / "my own, really" / "mine.sumocfg";
  std::ofstream(file) << "<configuration><n v=\"net.net.xml\"/><r "
                         "v=\"demand.rou.xml\"/></configuration>";
  for (const std::string backend : {"traci", "libsumo"}) {
    const ProcessResult result =
        run(file.string(), backend, {"--duration", "2", "--backend", backend});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  }
}

// names that SUMO 1.15 doesn't know, on one lane alone and beside others
TEST_F(UserConfigTest, ANetworkOfANewerSumoIsConverted) {
  std::string net = content(folder_ / "own" / "net.net.xml");
  const std::string old_text = "disallow=\"";
  const std::size_t at = net.find(old_text, net.find("<lane "));
  ASSERT_NE(at, std::string::npos);
  net.insert(at + old_text.size(), "cable_car wheelchair ");
  put("net.net.xml", net);
  const std::string file = config("net.net.xml", "demand.rou.xml");
  for (const std::string backend : {"traci", "libsumo"})
    expect_refused(run(file, "out", {"--duration", "2", "--backend", backend}), "--convert");
  const ProcessResult result = run(file, "out", {"--duration", "2", "--convert"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("cable_car (1), wheelchair (1)"));
  EXPECT_TRUE(fs::exists(out() / "converted.net.xml"));
}

TEST_F(UserConfigTest, WhatIsMissingOrWrongIsNamed) {
  const std::vector<std::string> more = {"--duration", "5"};
  expect_refused(run((folder_ / "none.sumocfg").string(), "out", more), "no such scenario");
  expect_refused(run(folder_.string(), "out", more), "no scenario.sumocfg");
  expect_refused(run(config("none.net.xml", "demand.rou.xml"), "out", more), "none.net.xml");
  expect_refused(run(config("net.net.xml", "none.rou.xml"), "out", more), "none.rou.xml");
  expect_refused(run(config(""), "out", more), "net-file");
  put("bad.rou.xml",
      "<routes><vehicle id=\"a\" depart=\"0\"><route edges=\"nosuch\"/></vehicle></routes>");
  expect_refused(run(config("net.net.xml", "bad.rou.xml"), "out", more), "nosuch");
  expect_refused(
      run(config("net.net.xml", "bad.rou.xml"), "out", {"--duration", "5", "--backend", "libsumo"}),
      "nosuch");
  put("bad.net.xml", content(folder_ / "own" / "net.net.xml").substr(0, 3000));
  expect_refused(run(config("bad.net.xml", "demand.rou.xml"), "out", more), "bad.net.xml");
  put("mine.sumocfg", "no XML at all");
  expect_refused(run((folder_ / "own" / "mine.sumocfg").string(), "out", more), "mine.sumocfg");
}

// a road over a bridge, another under it, and a light that shows red for a minute and a half: only
// who knows which lane somebody is on can tell that nobody collides and nobody is stuck
TEST_F(RunTest, WhomSumoDrivesIsJudgedByTheLaneItIsOn) {
  auto put = [&](const char* name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  };
  put("a.nod.xml",
      R"(<nodes><node id="w" x="0" y="0" z="0"/><node id="e" x="300" y="0" z="0"/>
         <node id="light" x="200" y="0" z="0" type="traffic_light"/>
         <node id="s" x="100" y="-100" z="6"/><node id="n" x="100" y="100" z="6"/></nodes>)");
  put("a.edg.xml",
      R"(<edges><edge id="under" from="w" to="light" numLanes="1" speed="13.9"/>
         <edge id="on" from="light" to="e" numLanes="1" speed="13.9"/>
         <edge id="over" from="s" to="n" numLanes="1" speed="13.9"/></edges>)");
  ProcessRequest convert;
  convert.arguments = {"netconvert",
                       "-n",
                       (folder_ / "a.nod.xml").string(),
                       "-e",
                       (folder_ / "a.edg.xml").string(),
                       "-o",
                       (folder_ / "a.net.xml").string()};
  ASSERT_EQ(run_process(convert).exit_code, 0);
  put("a.add.xml",
      R"(<additional><tlLogic id="light" type="static" programID="long" offset="0">
         <phase duration="90" state="r"/><phase duration="30" state="G"/></tlLogic></additional>)");
  put("a.rou.xml",
      R"(<routes><flow id="below" begin="0" end="40" period="4" departSpeed="max">
         <route edges="under on"/></flow>
         <flow id="above" begin="0" end="120" period="2" departSpeed="max">
         <route edges="over"/></flow></routes>)");
  put("a.sumocfg",
      R"(<configuration><net-file value="a.net.xml"/><route-files value="a.rou.xml"/>
         <additional-files value="a.add.xml"/></configuration>)");
  for (const std::string backend : {"traci", "libsumo"}) {
    const ProcessResult result =
        run((folder_ / "a.sumocfg").string(), backend,
            {"--duration", "120", "--control", "none", "--backend", backend});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json results = results_in(backend);
    EXPECT_GT(results["agents"]["arrived"], 50);
    EXPECT_EQ(results["collisions"]["unique_pairs"], 0) << content(out(backend) / "collisions.csv");
    EXPECT_EQ(results["flow"]["stuck_agents"], 0) << content(out(backend) / "stuck.csv");
    EXPECT_GT(results["flow"]["waiting_time_mean_s"], 5.0) << "nobody waited at the light";
  }
}

TEST_F(RunTest, WrongOptionsAreRefused) {
  import(kFixtures / "zebra_right.osm", "5");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--agents", "0"}, "--agents"},
      {{"--agents", std::string(300, '9')}, "--agents"},
      {{"--step", "0.0504"}, "whole milliseconds"},
      {{"--step", "nan"}, "--step"},
      {{"--duration", "0"}, "--duration"},
      {{"--duration", "inf"}, "--duration"},
      {{"--duration", "1e300"}, "--duration"},
      {{"--region", "0,0,nan,5"}, "--region"},
      {{"--seed", "-1"}, "--seed"},
      {{"--set", "run.duration=nan"}, "run.duration"},
      {{"--control", "cat"}, "the nearest one is 'car'"},
      {{"--sumo-options", "--mesosim true"}, "mesosim"},
      {{"--agents", "-5"}, "--agents"},
      {{"--agents", "many"}, "--agents"},
      {{"--step", "0"}, "--step"},
      {{"--step", "2"}, "--step"},
      {{"--duration", "-1"}, "--duration"},
      {{"--backend", "matsim"}, "--backend"},
      {{"--control", "all,car"}, "--control"},
      {{"--threads", "0"}, "--threads"},
      {{"--set", "nosuch=1"}, "nosuch"},
      {{"--connect", "nowhere"}, "HOST:PORT"},
      {{"--fail-on", "rain"}, "--fail-on"},
      {{"--region", "1,2,3"}, "--region"},
      {{"--sumo-options", "--no-such-option"}, "no-such"}};
  for (const auto& [options, words] : cases) {
    SCOPED_TRACE(options[0] + " " + options[1]);
    const ProcessResult result = run(scenario(), "out", options);
    expect_refused(result, words);
    EXPECT_LT(result.errors.size(), 400u) << "a number of hundreds of digits?";
  }
}

TEST_F(RunTest, AFolderWithAnotherRunIsKept) {
  import(kFixtures / "zebra_right.osm", "5");
  ASSERT_EQ(run(scenario(), "out", {"--duration", "5"}).exit_code, 0);
  const std::string before = content(out() / "results.json");
  const ProcessResult again = run(scenario(), "out", {"--duration", "6"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.errors, HasSubstr("--force"));
  EXPECT_EQ(content(out() / "results.json"), before);
  EXPECT_EQ(run(scenario(), "out", {"--duration", "6", "--force"}).exit_code, 0);
  EXPECT_EQ(results_in("out")["duration"], 6.0);
}

TEST_F(RunTest, AFullDiskOnStdoutIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  import(kFixtures / "zebra_right.osm", "5");
  const std::vector<std::string> commands = {
      "version", "--help", "run " + scenario() + " -o " + out().string() + " --duration 2"};
  for (const std::string& rest : commands) {
    ProcessRequest request;
    request.arguments = {"sh", "-c", SUMOGAMMA_PROGRAM " " + rest + " --quiet > /dev/full"};
    request.time_limit = 300.0;
    const ProcessResult result = run_process(request);
    EXPECT_EQ(result.exit_code, 2) << rest;
    EXPECT_THAT(result.errors, HasSubstr("standard output")) << rest;
  }
}

TEST_F(RunTest, AnOutputFolderThatCanNotBeMadeIsRefused) {
  import(kFixtures / "zebra_right.osm", "5");
  std::ofstream(folder_ / "file") << "not a folder";
  for (const std::string& place :
       {std::string("/dev/null/x"), std::string("/proc/x"), (folder_ / "file").string()}) {
    const ProcessResult result =
        program({"run", scenario(), "-o", place, "--duration", "5", "--quiet"});
    EXPECT_EQ(result.exit_code, 2) << place;
    EXPECT_THAT(result.errors, HasSubstr(place));
  }
}

TEST_F(RunTest, AFullDiskIsReported) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  import(kFixtures / "zebra_right.osm", "5");
  for (const char* file : {"trajectories.fcd.xml.gz", "replay.bin"}) {
    fs::remove_all(out());
    fs::create_directories(out());
    fs::create_symlink("/dev/full", out() / file);
    const ProcessResult result = run(
        scenario(), "out", {"--duration", "20", "--replay", "--trajectory-period", "0", "--force"});
    EXPECT_EQ(result.exit_code, 2) << file << "\n" << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(file));
  }
}

// --- a run that is cut short

/// The program as a child in a process group of its own, as a terminal starts it.
class LiveRun {
 public:
  LiveRun(std::vector<std::string> arguments, const fs::path& errors) {
    arguments.insert(arguments.begin(), SUMOGAMMA_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT, 0644);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    EXPECT_EQ(
        posix_spawn(&pid_, SUMOGAMMA_PROGRAM, &actions, &attributes, pointers.data(), environ), 0);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~LiveRun() {
    if (pid_ > 0) {
      kill(-pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  void interrupt() const { kill(-pid_, SIGINT); }
  /// Its SUMO, 0 where it has none.
  pid_t sumo() const {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      const std::string stat = content(entry.path() / "stat");
      const std::size_t after = stat.rfind(')');
      if (after == std::string::npos || after + 4 > stat.size()) continue;
      if (std::atoi(stat.c_str() + after + 4) == pid_) return std::atoi(name.c_str());
    }
    return 0;
  }
  bool wait_for(const std::function<bool()>& condition) const {
    for (int k = 0; k < 600; ++k) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  /// Waits for its end: the exit code, or minus the signal.
  int end() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t pid_ = 0;
};

class CutShortTest : public RunTest {
 protected:
  std::unique_ptr<LiveRun> start(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "run", scenario(),   "-o",    out().string(), "--quiet", "--replay", "--trajectory-period",
        "0",   "--duration", "100000"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto live = std::make_unique<LiveRun>(arguments, folder_ / "errors.txt");
    // in mid-run: the first trajectories have been written
    const fs::path trajectories = out() / "trajectories.fcd.xml.gz";
    EXPECT_TRUE(live->wait_for([&] {
      std::error_code not_yet;
      const std::uintmax_t size = fs::file_size(trajectories, not_yet);
      return !not_yet && size > 20000;
    })) << "the run did not start";
    return live;
  }
};

TEST_F(CutShortTest, CtrlCEndsWithWholeOutputs) {
  import(kFixtures / "signalled_crossing_right.osm", "20");
  for (const char* backend : {"traci", "libsumo"}) {
    SCOPED_TRACE(backend);
    fs::remove_all(out());
    const auto live = start({"--backend", backend});
    const pid_t sumo = live->sumo();
    live->interrupt();
    EXPECT_EQ(live->end(), 130) << content(folder_ / "errors.txt");
    EXPECT_EQ(results_in("out")["ended"], "interrupted");
    expect_whole_outputs("out");
    if (sumo > 0) {
      EXPECT_FALSE(fs::exists("/proc/" + std::to_string(sumo))) << "SUMO lives on";
    }
  }
}

TEST_F(CutShortTest, ASumoThatIsKilledIsReportedAndReaped) {
  import(kFixtures / "signalled_crossing_right.osm", "20");
  const auto live = start();
  const pid_t sumo = live->sumo();
  ASSERT_GT(sumo, 0) << "no SUMO to kill";
  kill(sumo, SIGKILL);
  EXPECT_EQ(live->end(), 3) << content(folder_ / "errors.txt");
  EXPECT_FALSE(fs::exists("/proc/" + std::to_string(sumo))) << "a zombie is left";
  const std::string errors = content(folder_ / "errors.txt");
  EXPECT_THAT(errors, HasSubstr("sumo-gamma: SUMO"));
  EXPECT_THAT(errors, HasSubstr("signal 9"));
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  const json results = results_in("out");
  EXPECT_EQ(results["ended"], "SUMO failed");
  EXPECT_GT(results["duration"], 1.0);
  expect_whole_outputs("out");
}

}  // namespace
}  // namespace sumogamma
