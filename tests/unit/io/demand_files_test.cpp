#include "io/demand_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "io/output_file.h"

namespace sumogamma {
namespace {

using ::testing::HasSubstr;

class DemandFiles : public ::testing::Test {
 protected:
  std::filesystem::path put(const std::string& text) const {
    const auto file = std::filesystem::temp_directory_path() /
                      ("demand_files_" + std::to_string(getpid()) + ".txt");
    write_file(file, text);
    return file;
  }
  std::string refusal(const std::string& text, bool counts) const {
    try {
      if (counts)
        read_counts(put(text));
      else
        read_od_table(put(text), default_agent_types());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(DemandFiles, ATableOfTripsIsReadByItsColumns) {
  const auto trips = read_od_table(
      put("type,per_hour,from,to\r\ncar,12.5,a,b\r\nbus,4,\"c,d\",e\n"), default_agent_types());
  ASSERT_EQ(trips.size(), 2u);
  EXPECT_EQ(trips[0].type, "car");
  EXPECT_EQ(trips[0].per_hour, 12.5);
  EXPECT_EQ(trips[1].from, "c,d");
  EXPECT_EQ(trips[1].to, "e");
}

TEST_F(DemandFiles, WhatIsNoTableOfTripsIsRefusedByName) {
  EXPECT_THAT(refusal("from,to,per_hour\na,b,3\n", false), HasSubstr("no column 'type'"));
  EXPECT_THAT(refusal("from,to,type,per_hour\na,b,carr,3\n", false),
              HasSubstr(":2: 'carr' is no agent type, the nearest known one is 'car'"));
  for (const char* number : {"-1", "x", "nan", "inf", ""})
    EXPECT_THAT(refusal("from,to,type,per_hour\na,b,car," + std::string(number) + "\n", false),
                HasSubstr("per_hour must be"))
        << number;
  EXPECT_THAT(refusal("from,to,type,per_hour\n", false), HasSubstr("no trips"));
  EXPECT_THAT(refusal("", false), HasSubstr("no trips"));
}

TEST_F(DemandFiles, CountsAreSummedUpOverIntervals) {
  const auto counts = read_counts(put(R"(<data>
    <interval begin="0" end="900"><edge id="a" entered="100"/></interval>
    <interval begin="900" end="1800"><edge id="a" entered="50"/>
      <edgeRelation from="a" to="b" count="20"/></interval></data>)"));
  ASSERT_EQ(counts.size(), 2u);
  EXPECT_EQ(counts[0].edge, "a");
  EXPECT_DOUBLE_EQ(counts[0].per_hour, 300);
  EXPECT_EQ(counts[1].to, "b");
  EXPECT_DOUBLE_EQ(counts[1].per_hour, 40);
}

TEST_F(DemandFiles, WhatAreNoCountsIsRefusedByName) {
  EXPECT_THAT(refusal("no xml", true), HasSubstr("is no XML"));
  EXPECT_THAT(refusal("<data/>", true), HasSubstr("counts nothing"));
  EXPECT_THAT(
      refusal(R"(<d><interval begin="5" end="5"><edge id="a" entered="1"/></interval></d>)", true),
      HasSubstr("ends at or before it"));
  for (const char* number : {"-1", "x", "nan", ""})
    EXPECT_THAT(refusal(R"(<d><interval begin="0" end="5"><edge id="a" entered=")" +
                            std::string(number) + R"("/></interval></d>)",
                        true),
                HasSubstr("no entered of 0 or more"))
        << number;
}

}  // namespace
}  // namespace sumogamma
