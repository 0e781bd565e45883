#include "io/config.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace sumogamma {
namespace {

class Config : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::temp_directory_path() /
            ("sumogamma_config_" + std::to_string(getpid()) + ".toml");
  }
  void TearDown() override { std::filesystem::remove(file_); }

  ScenarioConfig read(const std::string& content, const std::vector<std::string>& overrides = {}) {
    std::ofstream(file_) << content;
    return read_config(file_, overrides);
  }
  std::string complaint(const std::string& content,
                        const std::vector<std::string>& overrides = {}) {
    try {
      read(content, overrides);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  static const AgentType& type(const ScenarioConfig& config, const char* name) {
    return type_of(config.types, find_agent_type(config.types, name));
  }

  std::filesystem::path file_;
};

TEST_F(Config, DefaultsWithoutAFile) {
  const ScenarioConfig config = read_config("");
  EXPECT_EQ(config.agents, 100);
  EXPECT_EQ(config.types.size(), default_agent_types().size());
}

TEST_F(Config, ReadsEverySection) {
  const ScenarioConfig config = read(R"(
[scenario]
name = "Monaco"
[run]
agents = 250
duration = 90
step = 0.1
[model]
use_polygons = false
pair_horizon = "longest"
[types.car]
headway = 1.5
)");
  EXPECT_EQ(config.name, "Monaco");
  EXPECT_EQ(config.agents, 250);
  EXPECT_DOUBLE_EQ(config.duration, 90);
  EXPECT_FALSE(config.model.use_polygons);
  EXPECT_EQ(config.model.pair_horizon, PairHorizon::Longest);
  EXPECT_DOUBLE_EQ(type(config, "car").headway, 1.5);
  EXPECT_DOUBLE_EQ(type(config, "car").length, 4.5);
}

TEST_F(Config, AddsATypeFromABase) {
  const ScenarioConfig config =
      read("[types.rickshaw]\nbase = \"electric_tricycle\"\nlength = 2.9\n");
  EXPECT_EQ(config.types.size(), default_agent_types().size() + 1);
  EXPECT_DOUBLE_EQ(type(config, "rickshaw").length, 2.9);
  EXPECT_EQ(type(config, "rickshaw").sumo_class, type(config, "electric_tricycle").sumo_class);
}

TEST_F(Config, OverridesWinInOrder) {
  const ScenarioConfig config =
      read("[run]\nagents = 10\n",
           {"run.agents=20", "run.agents=30", "types.car.min_gap=2", "run.control=none"});
  EXPECT_EQ(config.agents, 30);
  EXPECT_DOUBLE_EQ(type(config, "car").min_gap, 2.0);
  EXPECT_EQ(config.control, "none");
}

TEST_F(Config, UnknownKeysNameFileLineAndNearest) {
  const std::string what = complaint("[run]\nagents = 10\n\n[types.car]\nheadwy = 1\n");
  EXPECT_NE(what.find(file_.string() + ":5"), std::string::npos) << what;
  EXPECT_NE(what.find("'types.car.headwy'"), std::string::npos) << what;
  EXPECT_NE(what.find("'types.car.headway'"), std::string::npos) << what;
  EXPECT_NE(complaint("", {"run.agent=3"}).find("'run.agents'"), std::string::npos);
  EXPECT_NE(complaint("agents = 3").find("'run.agents'"), std::string::npos);
}

TEST_F(Config, WrongValuesAreRefused) {
  EXPECT_NE(complaint("[run]\nagents = \"many\"").find("whole number"), std::string::npos);
  EXPECT_NE(complaint("[run]\nagents = 0").find("at least 1"), std::string::npos);
  EXPECT_NE(complaint("[run]\nstep = 0").find("above 0"), std::string::npos);
  EXPECT_NE(complaint("[run]\non_foot = 1.2").find("from 0 to 1"), std::string::npos);
  EXPECT_NE(complaint("[run]\nstep = nan").find("above 0"), std::string::npos);
  EXPECT_NE(complaint("[run]\nstep = inf").find("above 0"), std::string::npos);
  EXPECT_NE(complaint("[model]\nuse_polygons = 1").find("true or false"), std::string::npos);
  EXPECT_NE(
      complaint("[model]\npair_horizon = \"middle\"").find("\"own\", \"shortest\", \"longest\""),
      std::string::npos);
  EXPECT_NE(complaint("[scenario]\nname = 3").find("text"), std::string::npos);
  EXPECT_NE(complaint("[types.car]\nlength = -4").find("above 0"), std::string::npos);
  EXPECT_NE(complaint("[types.tank]\nlength = 7").find("base"), std::string::npos);
  EXPECT_NE(complaint("[types.tank]\nbase = \"lorry\"").find("lorry"), std::string::npos);
  EXPECT_NE(complaint("[types.car]\nbase = \"van\"").find("exists already"), std::string::npos);
  EXPECT_NE(complaint("types = 3").find("table"), std::string::npos);
  EXPECT_NE(complaint("run = 3").find("unknown key 'run'"), std::string::npos);
}

TEST_F(Config, ReadsTheRulesOfTheRoad) {
  const ScenarioConfig config =
      read("[traffic]\nstuck = 30\nturn_on_red = true\n", {"traffic.time_gap=1.5"});
  EXPECT_DOUBLE_EQ(config.traffic.stuck, 30.0);
  EXPECT_DOUBLE_EQ(config.traffic.time_gap, 1.5);
  EXPECT_DOUBLE_EQ(config.traffic.desperate, TrafficParameters{}.desperate);
  EXPECT_TRUE(config.code.turn_on_red);
  EXPECT_FALSE(read("").code.turn_on_red);
  // levels of patience may be moved together
  EXPECT_DOUBLE_EQ(read("", {"traffic.pressing=25", "traffic.stuck=30"}).traffic.pressing, 25.0);
}

TEST_F(Config, WrongRulesOfTheRoadAreRefused) {
  const std::string range = complaint("", {"traffic.stuck=600"});
  EXPECT_NE(range.find("'traffic.stuck'"), std::string::npos) << range;
  EXPECT_NE(range.find("from 8 to 60"), std::string::npos) << range;
  EXPECT_NE(complaint("[traffic]\npressing = 50\n").find("'traffic.pressing'"), std::string::npos);
  // in its range, and yet behind the level that follows it
  const std::string order = complaint("", {"traffic.pressing=25"});
  EXPECT_NE(order.find("traffic.pressing = 25"), std::string::npos) << order;
  EXPECT_NE(order.find("traffic.stuck = 20"), std::string::npos) << order;
  const std::string unknown = complaint("", {"traffic.desparate=30"});
  EXPECT_NE(unknown.find("'traffic.desperate'"), std::string::npos) << unknown;
  EXPECT_NE(complaint("[traffic]\nturn_on_red = 1\n").find("true or false"), std::string::npos);
}

TEST_F(Config, KeysOfTypesWinOverThePresetWhereverItStands) {
  const std::string key = "[types.motorcycle]\nred_light_running = 0.1\n";
  const std::string preset = "[behavior]\npreset = \"observed\"\n";
  for (const std::string& content : {key + preset, preset + key}) {
    const ScenarioConfig config = read(content);
    EXPECT_EQ(config.preset, BehaviorPreset::Observed);
    EXPECT_DOUBLE_EQ(type(config, "motorcycle").compliance.red_light_running, 0.1);
    EXPECT_DOUBLE_EQ(type(config, "bicycle").compliance.red_light_running, 0.391);
  }
  EXPECT_DOUBLE_EQ(type(read(key), "bicycle").compliance.red_light_running, 0.0);
  // in a shell: the last preset counts, and it leaves what the file says of a type
  const ScenarioConfig config =
      read(key, {"types.car.critical_gap=2", "behavior.preset=compliant",
                 "behavior.preset=observed", "types.car.headway_deviation=0"});
  EXPECT_DOUBLE_EQ(type(config, "motorcycle").compliance.red_light_running, 0.1);
  EXPECT_DOUBLE_EQ(type(config, "car").critical_gap, 2.0);
  EXPECT_DOUBLE_EQ(type(config, "car").compliance.headway_deviation, 0.0);
  EXPECT_DOUBLE_EQ(type(config, "car").compliance.red_light_running, 0.011);
  EXPECT_EQ(read("").preset, BehaviorPreset::Compliant);
}

TEST_F(Config, AnUnknownPresetNamesTheKnownOnes) {
  const std::string what = complaint("[run]\nagents = 10\n[behavior]\npreset = \"wild\"\n");
  EXPECT_NE(what.find(file_.string() + ":4"), std::string::npos) << what;
  EXPECT_NE(what.find("'behavior.preset' must be one of \"compliant\", \"observed\""),
            std::string::npos)
      << what;
  EXPECT_NE(complaint("", {"behavior.preset=wild"}).find("--set behavior.preset=wild"),
            std::string::npos);
  EXPECT_NE(complaint("[types.car]\nyielding_rate = 1.2").find("from 0 to 1"), std::string::npos);
  EXPECT_NE(complaint("[types.car]\nred_light_running = -0.1").find("from 0 to 1"),
            std::string::npos);
}

TEST_F(Config, BrokenTomlNamesItsLine) {
  EXPECT_NE(complaint("[run]\nagents = = 3\n").find(":2: not TOML"), std::string::npos);
  EXPECT_THROW(read_config(file_.string() + ".absent"), Error);
  EXPECT_THROW(read("", {"run.agents"}), Error);
  EXPECT_THROW(read("", {"=3"}), Error);
  EXPECT_THROW(read("", {"a b c=3"}), Error);
}

}  // namespace
}  // namespace sumogamma
