#include "osm/netconvert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"

namespace sumogamma::osm {
namespace {

using testing::ElementsAre;
using testing::Pair;
using testing::UnorderedElementsAre;

TEST(CountMessageKinds, ForgetsIdsAndNumbers) {
  const std::string log =
      "Warning: Edge '12#3' has a grade of 12.4%.\n"
      "Warning: Edge '-99' has a grade of 8.0%.\n"
      "Loading map ... done.\n"
      "Error: No way found for '7'\n";
  EXPECT_THAT(count_message_kinds(log),
              UnorderedElementsAre(Pair("Warning: Edge '*' has a grade of N%.", 2),
                                   Pair("Error: No way found for '*'", 1)));
  EXPECT_TRUE(count_message_kinds("").empty());
}

TEST(ReadJoins, TakesTheGroupsOfAFile) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("sumogamma_joins_" + std::to_string(getpid()));
  std::ofstream(file) << "<nodes><join nodes=\"1 22\"/><joinExclude nodes=\"7\"/>"
                         "<join nodes=\"3 4 5\" x=\"1\"/></nodes>";
  EXPECT_THAT(read_joins(file), ElementsAre(ElementsAre("1", "22"), ElementsAre("3", "4", "5")));
  std::ofstream(file) << "no XML";
  EXPECT_THROW(read_joins(file), Error);
  std::filesystem::remove(file);
  EXPECT_THROW(read_joins(file), Error);
}

}  // namespace
}  // namespace sumogamma::osm
