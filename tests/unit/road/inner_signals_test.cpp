#include "road/inner_signals.h"

#include <gtest/gtest.h>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

struct Boxes {
  double apart = 24;           ///< between the two signals [m]
  bool crossed_first = true;   ///< a road crosses at the first signal
  bool crossed_second = true;  ///< and at the second
  bool signal_first = true;    ///< it is one
};

/// Storage of the signal at B on the way over A and B [m].
///
///           N     M
///           v     v
///    W ---> A --> B ---> E
///           v     v
///           S     T
double storage(const Boxes& boxes) {
  const std::string b = std::to_string(boxes.apart);
  testing::PlainNet plain;
  plain.nodes =
      "<node id='W' x='-100' y='0'/><node id='E' x='200' y='0'/><node id='A' x='0' y='0'" +
      std::string(boxes.signal_first ? " type='traffic_light'" : " type='priority'") +
      "/><node id='B' x='" + b +
      "' y='0' type='traffic_light'/><node id='N' x='0' y='100'/><node id='S' x='0' "
      "y='-100'/><node id='M' x='" +
      b + "' y='100'/><node id='T' x='" + b + "' y='-100'/>";
  std::vector<std::string> roads = {"WA", "AB", "BE"};
  if (boxes.crossed_first) roads.insert(roads.end(), {"NA", "AS"});
  if (boxes.crossed_second) roads.insert(roads.end(), {"MB", "BT"});
  for (const std::string& road : roads)
    plain.edges += "<edge id='" + road + "' from='" + road[0] + "' to='" + road[1] +
                   "' numLanes='1' speed='13'/>";
  const RoadNetwork network = testing::read_plain_net(plain);
  const Lane& lane = network.lane(network.lane_by_name.at("AB_0"));
  for (const ConnectionId id : network.lane(network.lane_by_name.at("WA_0")).outgoing)
    EXPECT_EQ(network.connection(id).storage, 0.0) << "an outer signal";
  double found = 0.0;
  for (const ConnectionId id : lane.outgoing)
    found = std::max(found, network.connection(id).storage);
  return found;
}

TEST(InnerSignals, LieBetweenTheBoxesOfOneCrossing) {
  const double found = storage({});
  EXPECT_GT(found, 10.0) << "the junction before it counts";
  EXPECT_LT(found, 40.0);
}

TEST(InnerSignals, AreNoneWhereAQueueHasRoom) { EXPECT_EQ(storage({.apart = 60}), 0.0); }

// a signal for people on foot right before or behind a junction is halted at
TEST(InnerSignals, AreNoneWhereNoRoadsCross) {
  EXPECT_EQ(storage({.crossed_first = false}), 0.0);
  EXPECT_EQ(storage({.crossed_second = false}), 0.0);
}

TEST(InnerSignals, AreNoneWhereOneGetsWithoutGreen) {
  EXPECT_EQ(storage({.signal_first = false}), 0.0);
}

}  // namespace
}  // namespace sumogamma
