#include "realism/map_matching.h"

#include <gtest/gtest.h>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

//                N
//                |         W, C, E on a line, N above C: 200 m each
//   W --------- C --------- E
RoadNetwork three_arms() {
  return testing::read_plain_net(
      {R"(<node id="W" x="-200" y="0"/><node id="C" x="0" y="0"/><node id="E" x="200" y="0"/>)"
       R"(<node id="N" x="0" y="200"/>)",
       R"(<edge id="WC" from="W" to="C" numLanes="1" speed="14" allow="passenger"/>)"
       R"(<edge id="CE" from="C" to="E" numLanes="1" speed="14" allow="passenger"/>)"
       R"(<edge id="CN" from="C" to="N" numLanes="1" speed="14" allow="pedestrian passenger"/>)",
       "",
       {}});
}

RecordedAgent agent_along(const Polyline& line, double from, double to, const Vec2& aside) {
  RecordedAgent agent;
  for (double along = from; along <= to; along += 1.0) {
    agent.position.push_back(line.point_at(along) + aside);
    agent.velocity.emplace_back(10.0 * line.direction_at(along));
    agent.heading.push_back(heading_of(line.direction_at(along)));
  }
  return agent;
}

class MapMatching : public ::testing::Test {
 protected:
  std::vector<std::string> names(const MatchedRoute& route) const {
    std::vector<std::string> names;
    for (const EdgeId edge : route.edges) names.push_back(network_.edge(edge).name);
    return names;
  }
  const Lane& lane(const char* name) const { return network_.lane(network_.lane_by_name.at(name)); }
  RoadNetwork network_ = three_arms();
};

TEST_F(MapMatching, FindsTheWayOverAJunction) {
  std::vector<Vec2> points = lane("WC_0").centerline.points();
  const std::vector<Vec2> onward = lane("CN_0").centerline.points();
  points.insert(points.end(), onward.begin(), onward.end());
  const RecordedAgent agent = agent_along(Polyline(points), 40, 300, {0.5, 0.5});
  const MatchedRoute route = match_route(network_, agent, vehicle_class::kPassenger);
  EXPECT_EQ(names(route), (std::vector<std::string>{"WC", "CN"}));
  EXPECT_NEAR(route.from_along, 40.5, 1.0);
  EXPECT_EQ(route.from, network_.lane_by_name.at("WC_0"));
  EXPECT_GE(route.near + 1, route.points);
}

TEST_F(MapMatching, FindsOneEdgeAlone) {
  const MatchedRoute route = match_route(
      network_, agent_along(lane("CE_0").centerline, 20, 120, {0, 0}), vehicle_class::kPassenger);
  EXPECT_EQ(names(route), std::vector<std::string>{"CE"});
  EXPECT_EQ(route.near, route.points);
}

TEST_F(MapMatching, FindsNoneBesideTheRoadOrTheWrongWay) {
  const Polyline& line = lane("CE_0").centerline;
  EXPECT_TRUE(match_route(network_, agent_along(line, 20, 120, {0, 30}), vehicle_class::kPassenger)
                  .edges.empty());
  const Polyline back(std::vector<Vec2>(line.points().rbegin(), line.points().rend()));
  const MatchedRoute route =
      match_route(network_, agent_along(back, 20, 120, {0, 0}), vehicle_class::kPassenger);
  EXPECT_TRUE(route.edges.empty());
  EXPECT_EQ(route.near, 0u);
  EXPECT_GT(route.points, 0u);
}

TEST_F(MapMatching, PeopleWalkOnLanesForThem) {
  const MatchedWalk walk =
      match_walk(network_, agent_along(lane("CN_0").centerline, 50, 90, {3, 0}));
  ASSERT_NE(walk.from, kNoEdge);
  EXPECT_EQ(network_.edge(walk.from).name, "CN");
  EXPECT_NEAR(walk.to_along - walk.from_along, 40.0, 1.5);
  EXPECT_EQ(match_walk(network_, agent_along(lane("WC_0").centerline, 10, 30, {0, 0})).from,
            kNoEdge);
}

}  // namespace
}  // namespace sumogamma
