#include "osm/repairs/unruled_junctions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

RoadNetwork with_junction(const std::string& name, const std::string& type) {
  RoadNetwork road;
  Junction junction;
  junction.name = name;
  junction.type = type;
  road.junctions = {junction};
  return road;
}

TEST(UnruledJunctions, AreToldWithAllTheirNodes) {
  const NodeGroup street = {"1", "2", "3", "4", "5"}, other = {"7", "8"};
  EXPECT_THAT(
      unruled_junctions(with_junction("cluster_1_2_3_4_#1more", "unregulated"), {other, street}),
      ElementsAre(street));
}

TEST(UnruledJunctions, OthersStay) {
  const std::vector<NodeGroup> joined = {{"1", "2"}};
  EXPECT_THAT(unruled_junctions(with_junction("cluster_1_2", "priority"), joined), IsEmpty());
  EXPECT_THAT(unruled_junctions(with_junction("1", "unregulated"), joined), IsEmpty())
      << "the map's own";
  EXPECT_THAT(unruled_junctions(with_junction("cluster_3_4", "unregulated"), joined), IsEmpty())
      << "joined for another reason";
}

}  // namespace
}  // namespace sumogamma::osm
