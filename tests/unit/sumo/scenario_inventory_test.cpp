#include "sumo/scenario_inventory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class ScenarioInventoryTest : public ::testing::Test {
 protected:
  ScenarioInventoryTest() {
    folder_.write("a.net.xml", "<net/>");
    folder_.write("d.rou.xml",
                  "<demand><vType id=\"ev\"/><vehicle id=\"v\" depart=\"0\" departSpeed=\"5\"/>"
                  "<trip id=\"t\" depart=\"1\" departSpeed=\"max\"/><flow id=\"f\"/>"
                  "<person id=\"p\"><walk/></person><include href=\"more.rou.xml\"/></demand>");
    folder_.write("more.rou.xml",
                  "<routes><vType id=\"cab\"><param key=\"has.toc.device\" "
                  "value=\"true\"/></vType><include href=\"d.rou.xml\"/></routes>");
    folder_.write("x.add.xml",
                  "<anything><calibrator id=\"c1\"/><e1Detector id=\"d1\"/><e1Detector "
                  "id=\"d2\"/><newThing id=\"n\"/><busStop id=\"b\"/></anything>");
    folder_.write("s.sumocfg",
                  "<configuration><n v=\"a.net.xml\"/><r v=\"d.rou.xml\"/><a v=\"x.add.xml\"/>"
                  "<random value=\"true\"/><device.toc.probability "
                  "value=\"0\"/><parking.maneuver value=\"true\"/></configuration>");
  }
  ScenarioInventory inventory(bool plain = false, bool with_ids = false) const {
    return take_inventory(find_scenario(folder_.file("s.sumocfg")), plain, with_ids);
  }
  std::vector<std::string> lines(bool plain = false) const {
    std::vector<std::string> lines;
    for (const NotFollowed& item : inventory(plain).not_followed) lines.push_back(describe(item));
    return lines;
  }
  TemporaryFolder folder_;
};

TEST_F(ScenarioInventoryTest, NamesElementAndFile) {
  EXPECT_THAT(lines(), Contains(HasSubstr("calibrator c1 in x.add.xml: not followed (")));
  EXPECT_THAT(lines(), Contains(HasSubstr("newThing n in x.add.xml: not followed (")));
  EXPECT_THAT(lines(), Contains(HasSubstr("param has.toc.device in more.rou.xml: not followed")));
  EXPECT_THAT(lines(), Contains(HasSubstr("option random in s.sumocfg: not followed (")));
  EXPECT_THAT(lines(), Contains(HasSubstr("option parking.maneuver in s.sumocfg: not followed")));
}

TEST_F(ScenarioInventoryTest, SumsUpWhatThereIsManyOf) {
  folder_.write("x.add.xml", "<add><vaporizer id=\"a\"/><vaporizer id=\"b\"/></add>");
  EXPECT_THAT(lines(), Contains(HasSubstr("2 vaporizer in x.add.xml: not followed (")));
}

TEST_F(ScenarioInventoryTest, SaysNothingOfWhatIsFollowedOrAsksForNothing) {
  for (const char* word : {"busStop", "vType", "walk", "anything", "device.toc", "include"})
    EXPECT_THAT(lines(), Not(Contains(HasSubstr(word)))) << word;
}

TEST_F(ScenarioInventoryTest, PlainSumoFollowsItsFiles) {
  EXPECT_THAT(lines(true), ::testing::ElementsAre(HasSubstr("option random")));
}

TEST_F(ScenarioInventoryTest, GathersSpeedsAtDeparture) {
  EXPECT_EQ(inventory().depart_speeds, (std::unordered_map<std::string, double>{{"v", 5.0}}));
  EXPECT_THAT(lines(), Not(Contains(HasSubstr("departSpeed"))));
  folder_.write("more.rou.xml",
                "<routes><flow id=\"f\" departSpeed=\"0\"/><vehicle id=\"w\" "
                "departSpeed=\"last\"/></routes>");
  EXPECT_EQ(inventory().depart_speeds.at("f"), 0.0);
  EXPECT_EQ(inventory().depart_speeds.count("w"), 0u);
  EXPECT_THAT(lines(), Contains(HasSubstr("vehicle departSpeed w in more.rou.xml: not followed")));
  EXPECT_EQ(flow_of("f.12"), "f");
  EXPECT_EQ(flow_of("f.x"), "");
}

TEST_F(ScenarioInventoryTest, GathersNames) {
  EXPECT_THAT(inventory().ids, IsEmpty());
  const ScenarioInventory all = inventory(false, true);
  EXPECT_THAT(all.types, ::testing::ElementsAre("cab", "ev"));
  EXPECT_TRUE(has_id(all, "v"));
  EXPECT_TRUE(has_id(all, "t"));
  EXPECT_TRUE(has_id(all, "p"));
  EXPECT_TRUE(has_id(all, "f.12"));
  for (const char* other : {"f", "f.", "f.x", "g.1", "w", ""}) EXPECT_FALSE(has_id(all, other));
  // a calibrator brings vehicles with ids of its own
  EXPECT_FALSE(all.complete);
}

TEST_F(ScenarioInventoryTest, GathersOutputsWithTheirFiles) {
  folder_.write("x.add.xml",
                "<add><inductionLoop id='d' lane='l' pos='1' file='d.xml'/><include "
                "href='y.add.xml'/><edgeData id='off' file='NUL' type='emissions'/></add>");
  folder_.write("y.add.xml",
                "<add><e3Detector id='e' file='/e.xml'><detEntry lane='a' pos='1'/><detExit "
                "lane='b' pos='2'/></e3Detector></add>");
  const std::vector<std::string> words = {"--tripinfo", folder_.file("t.xml")};
  const ScenarioInventory found =
      take_inventory(find_scenario(folder_.file("s.sumocfg"), words), false, false);
  ASSERT_EQ(found.outputs.size(), 3u);
  EXPECT_EQ(found.outputs[0].what, "tripinfo-output");
  EXPECT_EQ(found.outputs[1].what, "e1Detector");
  EXPECT_EQ(found.outputs[1].file, folder_.file("d.xml"));
  EXPECT_EQ(attribute_or(found.outputs[1].attributes, "pos"), "1");
  EXPECT_EQ(found.outputs[2].file, "/e.xml");
  ASSERT_EQ(found.outputs[2].parts.size(), 2u);
  EXPECT_EQ(found.outputs[2].parts[1].first, "detExit");
  EXPECT_THAT(found.output_folders, Contains(std::filesystem::path("/")));
  EXPECT_THAT(take_inventory(find_scenario(folder_.file("s.sumocfg"), words), true, false).outputs,
              IsEmpty());
}

TEST_F(ScenarioInventoryTest, RefusesOutputsThatWouldBeWrong) {
  const auto refusal = [&](bool plain) -> std::string {
    try {
      inventory(plain);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  folder_.write("x.add.xml", "<add><routeProbe id='p' edge='e' file='p.xml'/></add>");
  EXPECT_THAT(refusal(false), HasSubstr("x.add.xml: routeProbe p would be wrong"));
  EXPECT_EQ(refusal(true), "");
  folder_.write("x.add.xml", "<add><laneData id='m' file='m.xml' trackVehicles='true'/></add>");
  EXPECT_THAT(refusal(false), HasSubstr("laneData m, attribute trackVehicles"));
  folder_.write("x.add.xml", "<add><e1Detector id='d' lane='l' file='stdout'/></add>");
  EXPECT_THAT(refusal(false), HasSubstr("name a file"));
}

TEST_F(ScenarioInventoryTest, LeavesWhatIsNoXmlToSumo) {
  folder_.write("x.add.xml", "<add><calibrator id=\"c1\"/");
  EXPECT_THAT(lines(), Not(Contains(HasSubstr("x.add.xml"))));
}

}  // namespace
}  // namespace sumogamma
