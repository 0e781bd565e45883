#include "traffic/parameters.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

namespace sumogamma {
namespace {

TEST(TrafficParameters, NamesAreUniqueAndDefaultsLieInTheirRanges) {
  const TrafficParameters defaults;
  std::set<std::string_view> names;
  for (const TrafficParameter& one : traffic_parameters()) {
    SCOPED_TRACE(one.name);
    EXPECT_TRUE(names.insert(one.name).second);
    EXPECT_LT(one.least, one.most);
    EXPECT_GE(defaults.*one.value, one.least);
    EXPECT_LE(defaults.*one.value, one.most);
    EXPECT_FALSE(one.unit.empty());
    EXPECT_FALSE(one.meaning.empty());
  }
}

TEST(TrafficParameters, EachRowIsOfAValueOfItsOwn) {
  TrafficParameters all;
  for (const TrafficParameter& one : traffic_parameters()) all.*one.value = -1.0;
  for (const TrafficParameter& one : traffic_parameters()) {
    EXPECT_EQ(all.*one.value, -1.0) << one.name;
    all.*one.value = 1.0;
  }
}

// a page that tells other values is of no use
TEST(TrafficParameters, ThePageHasTheTable) {
  std::ifstream file(SUMOGAMMA_SOURCE_DIR "/docs/rules/parameters.md");
  std::stringstream page;
  page << file.rdbuf();
  EXPECT_NE(page.str().find("\n\n" + traffic_parameter_table()), std::string::npos)
      << "docs/rules/parameters.md should have this table:\n"
      << traffic_parameter_table();
}

}  // namespace
}  // namespace sumogamma
