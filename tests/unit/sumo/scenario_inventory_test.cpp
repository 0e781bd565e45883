#include "sumo/scenario_inventory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST_F(ScenarioInventoryTest, LeavesWhatIsNoXmlToSumo) {
  folder_.write("x.add.xml", "<add><calibrator id=\"c1\"/");
  EXPECT_THAT(lines(), Not(Contains(HasSubstr("x.add.xml"))));
}

}  // namespace
}  // namespace sumogamma
