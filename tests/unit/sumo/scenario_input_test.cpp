#include "sumo/scenario_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ScenarioInputTest : public ::testing::Test {
 protected:
  ScenarioInputTest() {
    for (const char* file : {"a.net.xml", "b.rou.xml", "c.add.xml", "d.add.xml"})
      folder_.write(file, "<x/>");
  }
  ScenarioInput find(const std::string& body) const {
    folder_.write("mine.sumocfg", "<configuration>" + body + "</configuration>");
    return find_scenario(folder_.file("mine.sumocfg"));
  }
  std::string complaint(const std::string& body) const {
    try {
      find(body);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  TemporaryFolder folder_;
};

TEST_F(ScenarioInputTest, ResolvesFilesBesideTheConfiguration) {
  const ScenarioInput input = find(
      "<input><net-file value=\"a.net.xml\"/><route-files value=\"b.rou.xml\"/>"
      "<additional-files value=\" c.add.xml, d.add.xml \"/></input><time><begin value=\"12.5\"/>"
      "<end value=\"60\"/></time>");
  EXPECT_EQ(input.name, "mine");
  EXPECT_EQ(input.network, fs::path(folder_.file("a.net.xml")));
  ASSERT_EQ(input.additional.size(), 2u);
  EXPECT_EQ(input.additional[1], fs::path(folder_.file("d.add.xml")));
  EXPECT_EQ(input.begin, 12.5);
  EXPECT_EQ(input.end, 60);
  EXPECT_TRUE(input.settings.empty());
}

TEST_F(ScenarioInputTest, TakesAbsolutePathsAndOtherNames) {
  const ScenarioInput input =
      find("<n v=\"" + folder_.file("a.net.xml") + "\"/><r v=\"b.rou.xml\"/><e v=\"1:00:00\"/>");
  EXPECT_EQ(input.network, fs::path(folder_.file("a.net.xml")));
  EXPECT_FALSE(input.begin);
  EXPECT_EQ(input.end, 3600);
}

// as SUMO reads it: no sections or nested ones, text instead of an attribute, the environment, %20
TEST_F(ScenarioInputTest, ReadsAnyShapeOfConfiguration) {
  setenv("SUMOGAMMA_TEST_NET", "a", 1);
  folder_.write("e f.rou.xml", "<x/>");
  const ScenarioInput input = find(
      "<deep><deeper><net value=\"${SUMOGAMMA_TEST_NET}.net.xml\"/></deeper></deep>"
      "<routes>\n b.rou.xml,,e%20f.rou.xml \n</routes><b value=\"0:01:00\"/>"
      "<step-length value=\"0.1\"/><seed value=\"42\"/><no-such-option value=\"1\"/>");
  EXPECT_EQ(input.network, fs::path(folder_.file("a.net.xml")));
  ASSERT_EQ(input.routes.size(), 2u);
  EXPECT_EQ(input.routes[1], fs::path(folder_.file("e f.rou.xml")));
  EXPECT_EQ(input.begin, 60);
  EXPECT_EQ(input.step_length, 0.1);
  EXPECT_EQ(input.seed, 42u);
}

TEST_F(ScenarioInputTest, WhatTheUserGivesToSumoWins) {
  folder_.write("mine.sumocfg",
                "<configuration><net-file value=\"a.net.xml\"/><additional-files "
                "value=\"c.add.xml\"/><begin value=\"10\"/></configuration>");
  const std::vector<std::string> words = {
      "-a", folder_.file("d.add.xml"), "--begin=20", "--ignore-route-errors", "-e", "1:00:00"};
  const ScenarioInput input = find_scenario(folder_.file("mine.sumocfg"), words);
  ASSERT_EQ(input.additional.size(), 1u);
  EXPECT_EQ(input.additional[0], fs::path(folder_.file("d.add.xml")));
  EXPECT_EQ(input.begin, 20);
  EXPECT_EQ(input.end, 3600);
  EXPECT_TRUE(is_on(input.options, "ignore-route-errors"));
}

TEST_F(ScenarioInputTest, RefusesAMesoscopicRun) {
  const std::string net = "<net-file value=\"a.net.xml\"/>";
  EXPECT_THAT(complaint(net + "<mesoscopic><mesosim value=\"true\"/></mesoscopic>"),
              HasSubstr("mesosim"));
  EXPECT_EQ(complaint(net + "<mesosim value=\"false\"/>"), "");
  const std::vector<std::string> words = {"--mesosim"};
  EXPECT_THROW(find_scenario(folder_.file("mine.sumocfg"), words), Error);
}

TEST_F(ScenarioInputTest, NamesValuesThatCanNotBeMeant) {
  const std::string net = "<net-file value=\"a.net.xml\"/>";
  EXPECT_THAT(complaint(net + "<begin value=\"nan\"/>"), HasSubstr("begin"));
  EXPECT_THAT(complaint(net + "<end value=\"later\"/>"), HasSubstr("later"));
  EXPECT_THAT(complaint(net + "<seed value=\"-3\"/>"), HasSubstr("seed"));
  EXPECT_THAT(complaint(net + "<n v=\"a.net.xml\"/>"), HasSubstr("twice"));
}

// SUMO splits at the comma of a folder, too
TEST_F(ScenarioInputTest, ReachesAFolderWithACommaInItsName) {
  fs::create_directory(folder_.file("a,b"));
  folder_.write("a,b/a.net.xml", "<x/>");
  folder_.write("a,b/mine.sumocfg", "<configuration><n v=\"a.net.xml\"/></configuration>");
  const ScenarioInput input = find_scenario(folder_.file("a,b/mine.sumocfg"));
  EXPECT_EQ(input.config_for_sumo.find(','), std::string::npos);
  EXPECT_TRUE(fs::equivalent(input.config_for_sumo, folder_.file("a,b/mine.sumocfg")));
  EXPECT_EQ(find("<n v=\"a.net.xml\"/>").config_for_sumo, folder_.file("mine.sumocfg"));
}

TEST_F(ScenarioInputTest, FindsTheSettingsBesideIt) {
  folder_.write("scenario.toml", "");
  EXPECT_EQ(find("<net-file value=\"a.net.xml\"/>").settings,
            fs::path(folder_.file("scenario.toml")));
}

TEST_F(ScenarioInputTest, AFolderIsKnownByItsScenario) {
  EXPECT_THROW(find_scenario(fs::path(folder_.file("a.net.xml")).parent_path()), Error);
  folder_.write("scenario.sumocfg",
                "<configuration><net-file value=\"a.net.xml\"/></configuration>");
  const ScenarioInput input = find_scenario(fs::path(folder_.file("a.net.xml")).parent_path());
  EXPECT_EQ(input.name, fs::path(folder_.file("x")).parent_path().filename().string());
  EXPECT_EQ(input.config.filename(), "scenario.sumocfg");
}

TEST_F(ScenarioInputTest, NamesWhatIsMissing) {
  EXPECT_THROW(find_scenario("/no/such/place"), Error);
  EXPECT_THAT(complaint("<net-file value=\"z.net.xml\"/>"), HasSubstr("z.net.xml"));
  EXPECT_THAT(
      complaint("<net-file value=\"a.net.xml\"/><route-files value=\"b.rou.xml,z.rou.xml\"/>"),
      HasSubstr("z.rou.xml"));
  EXPECT_THAT(complaint("<net-file value=\"a.net.xml\"/><additional-files value=\"z.add.xml\"/>"),
              HasSubstr("z.add.xml"));
  EXPECT_THAT(complaint("<input/>"), HasSubstr("net-file"));
  EXPECT_THAT(complaint("<net-file value=\"\"/>"), HasSubstr("net-file"));
}

TEST_F(ScenarioInputTest, NamesWhatIsNoConfiguration) {
  folder_.write("text.sumocfg", "certainly not XML");
  try {
    find_scenario(folder_.file("text.sumocfg"));
    FAIL() << "took a text for a configuration";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("text.sumocfg"));
    EXPECT_THAT(error.what(), HasSubstr("not a SUMO configuration"));
  }
}

}  // namespace
}  // namespace sumogamma
