#include "road/stop_lines.h"

#include <gtest/gtest.h>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

/// How far before their ends fronts wait on the three arms of a T with lanes of a width [m].
std::vector<double> setbacks(const std::string& width) {
  std::string edges;
  for (const std::string arm : {"W", "E", "S"})
    for (const auto& [from, to] : {std::pair{arm, std::string("C")}, {std::string("C"), arm}})
      edges += "<edge id='" + from + to + "' from='" + from + "' to='" + to +
               "' numLanes='1' width='" + width + "' speed='10'/>";
  const RoadNetwork network = testing::read_plain_net(
      {"<node id='C' x='0' y='0' type='right_before_left'/><node id='W' x='-100' y='0'/>"
       "<node id='E' x='100' y='0'/><node id='S' x='0' y='-100'/>",
       edges,
       "",
       {"--default.junctions.radius", "2"}});
  std::vector<double> found;
  for (const Connection& link : network.connections)
    if (network.edge(network.lane(link.from).edge).kind == LaneKind::Normal)
      found.push_back(link.setback);
  return found;
}

// two abreast on a path have room beside each other, but none to turn round who waits at its end
TEST(StopLines, OnNarrowPathsLeaveRoomToTurn) {
  const std::vector<double> found = setbacks("1");
  ASSERT_EQ(found.size(), 6u);
  for (const double setback : found) {
    EXPECT_GE(setback, 0.5);
    EXPECT_LE(setback, 3.0);
  }
}

}  // namespace
}  // namespace sumogamma
