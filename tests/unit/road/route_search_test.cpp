#include "road/route_search.h"

#include <gtest/gtest.h>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

using testing::read_plain_net;
using testing::two_ways;

class FastestRoute : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(two_ways(true));
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
