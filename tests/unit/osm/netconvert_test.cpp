#include "osm/netconvert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"
#include "support/converted_map.h"

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

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

// a main road with two side roads 8 m apart, one to each side
constexpr const char* kStaggered = R"xml(<?xml version="1.0"?>
<osm version="0.6">
  <node id="1" lat="51.0000" lon="-1.0015"/>
  <node id="2" lat="51.0002" lon="-1.0000"/>
  <node id="3" lat="51.0002" lon="-0.9999"/>
  <node id="4" lat="51.0000" lon="-0.9984"/>
  <node id="5" lat="51.0012" lon="-1.0000"/>
  <node id="6" lat="50.9992" lon="-0.9999"/>
  <way id="10"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><tag k="highway" v="primary"/></way>
  <way id="11"><nd ref="5"/><nd ref="2"/><tag k="highway" v="residential"/></way>
  <way id="12"><nd ref="6"/><nd ref="3"/><tag k="highway" v="residential"/></way>
</osm>)xml";

// netconvert 1.15 loses the place of what it is told to join in a network with left-hand traffic
TEST(RunNetconvert, JoinsNodesWhereTheyAre) {
  for (const bool left_hand : {false, true}) {
    ConvertedMap map(kStaggered, left_hand);
    run_netconvert(map.request);
    map.request.joins = {NodeGroup{"2", "3"}};
    run_netconvert(map.request, map.load().net());
    const RoadNetwork road = map.read();
    ASSERT_TRUE(road.junction_by_name.contains("cluster_2_3"));
    const Vec2 joined = road.junction(road.junction_by_name.at("cluster_2_3")).position;
    EXPECT_NEAR(joined.x(), 3.5, 1.0);
    EXPECT_NEAR(joined.y(), 22.3, 1.0);
    EXPECT_LT((road.upper_corner - road.lower_corner).norm(), 500.0);
  }
}

}  // namespace
}  // namespace sumogamma::osm
