#include "sumo/net_conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(NetConversion, LeavesOutWhatSumoDoesNotKnow) {
  const TemporaryFolder folder;
  folder.write("new.net.xml", R"(<net version="1.20">
    <type id="t" allow="subway"><restriction vClass="drone" speed="5"/>
      <restriction vClass="bus" speed="9"/></type>
    <edge id="e" from="a" to="b">
      <lane id="e_0" index="0" allow="subway cable_car"/>
      <lane id="e_1" index="1" allow="bus subway all"/>
      <lane id="e_2" index="2" disallow="pedestrian aircraft"/>
      <lane id="e_3" index="3" disallow="wheelchair scooter container"/>
      <lane id="e_4" index="4" allow="passenger" changeLeft="scooter"/>
      <stopOffset vClasses="drone" value="2"/>
    </edge></net>)");
  const ForeignClasses found = find_foreign_classes(folder.file("new.net.xml"));
  EXPECT_EQ(found.version, "1.20");
  EXPECT_EQ(describe(found),
            "aircraft (1), cable_car (1), container (1), drone (2), scooter (2), subway (3), "
            "wheelchair (1)");

  write_without_foreign_classes(folder.file("new.net.xml"), folder.file("copy.net.xml"));
  EXPECT_TRUE(find_foreign_classes(folder.file("copy.net.xml")).places.empty());
  const std::string copy = folder.read("copy.net.xml");
  // for foreign ones alone: for nobody, not for everybody
  EXPECT_THAT(copy, HasSubstr(R"(<lane id="e_0" index="0" disallow="all")"));
  EXPECT_THAT(copy, HasSubstr(R"(<type id="t" disallow="all")"));
  EXPECT_THAT(copy, HasSubstr(R"(<lane id="e_1" index="1" allow="bus all")"));
  EXPECT_THAT(copy, HasSubstr(R"(<lane id="e_2" index="2" disallow="pedestrian")"));
  EXPECT_THAT(copy, HasSubstr(R"(<lane id="e_3" index="3" />)"));
  EXPECT_THAT(copy, HasSubstr(R"(changeLeft="ignoring")"));
  EXPECT_THAT(copy, HasSubstr(R"(<restriction vClass="bus" speed="9" />)"));
  EXPECT_THAT(copy, Not(HasSubstr("stopOffset")));
}

}  // namespace
}  // namespace sumogamma
