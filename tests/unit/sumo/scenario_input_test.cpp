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
  EXPECT_EQ(input.begin, 0);
  EXPECT_LT(input.end, 0);  // not plain seconds
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
