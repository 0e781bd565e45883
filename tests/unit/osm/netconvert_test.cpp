#include "osm/netconvert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sumogamma::osm {
namespace {

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

}  // namespace
}  // namespace sumogamma::osm
