#include "demand/route_fit.h"

#include <gtest/gtest.h>

#include "scene/agent_type.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

using testing::PlainNet;
using testing::route_of;

// a side street joins a road of three lanes, of which the innermost alone turns left at the next
// junction: who comes out of it crosses two lanes on the way
//
//                      N
//                      |
//       W ---- A ----- B ---- E       A to B: three lanes, `length` long
//              |
//              S
RoadNetwork weave(double length) {
  const std::string b = std::to_string(length);
  PlainNet net;
  net.nodes =
      "<node id='W' x='-300' y='0'/><node id='A' x='0' y='0' type='priority'/><node id='B' x='" +
      b + "' y='0' type='priority'/><node id='E' x='" + std::to_string(length + 300) +
      "' y='0'/><node id='N' x='" + b + "' y='300'/><node id='S' x='0' y='-300'/>";
  net.edges =
      "<edge id='WA' from='W' to='A' numLanes='3' speed='13.89' priority='9'/>"
      "<edge id='AB' from='A' to='B' numLanes='3' speed='13.89' priority='9'/>"
      "<edge id='BE' from='B' to='E' numLanes='2' speed='13.89' priority='9'/>"
      "<edge id='BN' from='B' to='N' numLanes='1' speed='13.89' priority='1'/>"
      "<edge id='SA' from='S' to='A' numLanes='1' speed='13.89' priority='1'/>";
  net.connections =
      "<connection from='SA' to='AB' fromLane='0' toLane='0'/>"
      "<connection from='WA' to='AB' fromLane='0' toLane='0'/>"
      "<connection from='WA' to='AB' fromLane='1' toLane='1'/>"
      "<connection from='WA' to='AB' fromLane='2' toLane='2'/>"
      "<connection from='AB' to='BE' fromLane='0' toLane='0'/>"
      "<connection from='AB' to='BE' fromLane='1' toLane='1'/>"
      "<connection from='AB' to='BN' fromLane='2' toLane='0'/>";
  return testing::read_plain_net(net);
}

bool car_takes(const RoadNetwork& road, const std::vector<std::string>& edges) {
  const AgentTypeTable types = default_agent_types();
  return suits(road, type_of(types, find_agent_type(types, "car")), route_of(road, edges));
}

TEST(RouteFit, NobodyCrossesTwoLanesWithin90Metres) {
  const RoadNetwork near = weave(90);
  EXPECT_FALSE(car_takes(near, {"SA", "AB", "BN"}));
  EXPECT_TRUE(car_takes(near, {"SA", "AB", "BE"})) << "its lane leads on";
  EXPECT_TRUE(car_takes(near, {"WA", "AB", "BN"})) << "the third lane comes from the third";
  EXPECT_TRUE(car_takes(weave(150), {"SA", "AB", "BN"}));
  EXPECT_TRUE(car_takes(weave(15), {"SA", "AB", "BN"})) << "all one junction";
}

TEST(RouteFit, LongBodiesTakeNoSharpTurns) {
  PlainNet net;
  net.nodes = "<node id='A' x='0' y='0'/><node id='B' x='200' y='0'/><node id='C' x='60' y='80'/>";
  net.edges =
      "<edge id='AB' from='A' to='B' numLanes='1' speed='13.89'/>"
      "<edge id='BC' from='B' to='C' numLanes='1' speed='13.89'/>"
      "<edge id='BA' from='B' to='A' numLanes='1' speed='13.89'/>";
  const RoadNetwork road = testing::read_plain_net(net);
  const AgentTypeTable types = default_agent_types();
  const std::vector<EdgeId> sharp = route_of(road, {"AB", "BC"}),
                            back = route_of(road, {"AB", "BA"});
  EXPECT_FALSE(suits(road, type_of(types, find_agent_type(types, "bus")), sharp));
  EXPECT_TRUE(suits(road, type_of(types, find_agent_type(types, "motorcycle")), sharp));
  EXPECT_TRUE(turns_back(road, back));
  EXPECT_FALSE(turns_back(road, sharp));
}

}  // namespace
}  // namespace sumogamma
