#include "road/route_search.h"

#include <gtest/gtest.h>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

using testing::PlainNet;
using testing::read_plain_net;

//        N
//      /   |           A to D by N or by S, from the one lane of IA; everything both ways
//  I - A   D - O
//      |   /
//        S
PlainNet two_ways() {
  PlainNet plain;
  plain.nodes = R"(<node id="I" x="-150" y="0"/><node id="A" x="0" y="0"/>
    <node id="N" x="100" y="100"/><node id="S" x="100" y="-60"/><node id="D" x="200" y="0"/>
    <node id="O" x="350" y="0"/>)";
  for (const std::string way : {"IA", "AN", "ND", "AS", "SD", "DO"})
    for (const std::string& name : {way, std::string(way.rbegin(), way.rend())})
      plain.edges += "<edge id=\"" + name + "\" from=\"" + name[0] + "\" to=\"" + name[1] +
                     "\" numLanes=\"1\" speed=\"13\"/>";
  return plain;
}

class FastestRoute : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(two_ways());
    return network;
  }
  FastestRoute() : times_(net().edges.size()) {
    for (std::size_t i = 0; i < times_.size(); ++i)
      if (!net().edges[i].lanes.empty())
        times_[i] = net().lane(net().edges[i].lanes.front()).centerline.length() / 13.0;
  }
  std::vector<std::string> route(const std::string& from, const std::string& to) {
    std::vector<std::string> names;
    for (const EdgeId edge :
         fastest_route(net(), net().lane_by_name.at(from), net().edge_by_name.at(to),
                       vehicle_class::kPassenger, times_))
      names.push_back(net().edge(edge).name);
    return names;
  }
  void set_time(const std::string& edge, double seconds) {
    times_[index_of(net().edge_by_name.at(edge))] = seconds;
  }
  std::vector<double> times_;
};

using Names = std::vector<std::string>;

TEST_F(FastestRoute, TakesTheLeastTime) {
  EXPECT_EQ(route("IA_0", "DO"), (Names{"IA", "AS", "SD", "DO"}));
  set_time("SD", 100.0);
  EXPECT_EQ(route("IA_0", "DO"), (Names{"IA", "AN", "ND", "DO"}));
}

TEST_F(FastestRoute, NeverTurnsRound) {
  EXPECT_EQ(route("IA_0", "AI"), (Names{"IA", "AS", "SD", "DN", "NA", "AI"})) << "round the block";
  set_time("AN", 1e4);
  EXPECT_EQ(route("IA_0", "NA"), (Names{"IA", "AS", "SD", "DN", "NA"}));
}

TEST_F(FastestRoute, IsEmptyWhereNoWayLeads) {
  EXPECT_EQ(route("DO_0", "IA"), Names{});
  EXPECT_EQ(route("IA_0", "IA"), Names{});
}

}  // namespace
}  // namespace sumogamma
