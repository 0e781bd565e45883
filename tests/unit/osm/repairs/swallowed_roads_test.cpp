#include "osm/repairs/swallowed_roads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A road of one lane from a junction to another, its line as drawn.
void add_road(RoadNetwork& road, const char* from, const Vec2& begin, const char* to,
              const Vec2& end, const std::vector<Vec2>& drawn) {
  const auto junction = [&](const char* name, const Vec2& place) {
    for (std::size_t i = 0; i < road.junctions.size(); ++i)
      if (road.junctions[i].name == name) return static_cast<JunctionId>(i);
    Junction made;
    made.name = name;
    made.position = place;
    road.junctions.push_back(made);
    return static_cast<JunctionId>(road.junctions.size() - 1);
  };
  Edge edge;
  edge.from = junction(from, begin);
  edge.to = junction(to, end);
  Lane lane;
  lane.edge = static_cast<EdgeId>(road.edges.size());
  lane.centerline = Polyline(drawn);
  edge.lanes = {static_cast<LaneId>(road.lanes.size())};
  road.lanes.push_back(lane);
  road.edges.push_back(edge);
}

TEST(SwallowedRoads, LieOutsideOfBothTheirJunctions) {
  RoadNetwork road;
  add_road(road, "a", {0, 0}, "b", {3, 0}, {{-8, 0}, {-0.5, 0}});  // before its begin
  EXPECT_THAT(swallowed_roads(road), ElementsAre(ElementsAre("a", "b")));
  add_road(road, "c", {50, 0}, "d", {54, 0}, {{56, 1}, {62, 1}});  // behind its end
  EXPECT_THAT(swallowed_roads(road), ElementsAre(ElementsAre("a", "b"), ElementsAre("c", "d")));
}

// in the small rings of the Magic Roundabout who waited to go on stood across the way of those who
// left the ring, and each waited for the other
TEST(SwallowedRoads, OfCarsLeaveNoRoom) {
  RoadNetwork road;
  add_road(road, "a", {0, 0}, "b", {7, 0}, {{4, 0}, {4.2, 0}});
  EXPECT_THAT(swallowed_roads(road), ElementsAre(ElementsAre("a", "b")));
  road.junctions[1].position = {8.5, 0};
  EXPECT_THAT(swallowed_roads(road), IsEmpty()) << "too far apart for one junction";
  road.junctions[1].position = {7, 0};
  road.lanes[0].allowed = vehicle_class::kBicycle;
  EXPECT_THAT(swallowed_roads(road), IsEmpty()) << "a path for bicycles";
  road.lanes[0].allowed = vehicle_class::kPassenger;
  road.lanes[0].centerline = Polyline({{3, 0}, {5, 0}});
  EXPECT_THAT(swallowed_roads(road), IsEmpty()) << "two metres are left";
}

// a junction of a whole street has turns that lead backwards and walking areas without end
TEST(SwallowedRoads, AStreetOfDrivewaysIsNotOneJunction) {
  RoadNetwork road;
  constexpr int kDriveways = 12;
  const auto name = [](int i) { return "d" + std::to_string(i); };
  for (int i = 0; i < kDriveways; ++i) {
    const double x = 7.0 * i;
    add_road(road, name(i).c_str(), {x, 0}, name(i + 1).c_str(), {x + 7, 0},
             {{x + 3.4, 0}, {x + 3.6, 0}});
  }
  std::size_t joined = 0;
  for (const NodeGroup& group : swallowed_roads(road)) {
    EXPECT_LE(group.size(), 4u);
    joined += group.size();
  }
  EXPECT_GE(joined, 8u);
}

TEST(SwallowedRoads, OthersAreLeftAlone) {
  RoadNetwork road;
  add_road(road, "a", {0, 0}, "b", {6, 0}, {{2, 0}, {4, 0}});    // short, and between them
  add_road(road, "a", {0, 0}, "c", {0, 5}, {{0, 6}, {0, 6.2}});  // a path for bicycles
  road.lanes.back().allowed = vehicle_class::kBicycle;
  add_road(road, "c", {0, 5}, "d", {99, 5}, {{-9, 5}, {-1, 5}});    // far apart
  add_road(road, "d", {99, 5}, "e", {99, 8}, {{99, 9}, {99, 60}});  // a loop
  EXPECT_THAT(swallowed_roads(road), IsEmpty());
}

/// A link over a junction between the first lanes of two roads, drawn so.
void add_link(RoadNetwork& road, int from, int to, const std::vector<Vec2>& drawn) {
  const auto first_lane = [&](int edge) {
    return road.edges[static_cast<std::size_t>(edge)].lanes[0];
  };
  Connection link;
  link.from = first_lane(from);
  link.to = first_lane(to);
  link.junction = road.edges[static_cast<std::size_t>(from)].to;
  Lane inside;
  inside.kind = LaneKind::Internal;
  inside.centerline = Polyline(drawn);
  link.via = static_cast<LaneId>(road.lanes.size());
  road.lanes.push_back(inside);
  road.junctions[index_of(link.junction)].links.push_back(
      static_cast<ConnectionId>(road.connections.size()));
  road.connections.push_back(link);
}

// a queue at the signal b stands over the junction a, where a turn over b leads past: netconvert
// draws the ways of b beyond a where the two lie closer than its roads are wide
TEST(SignalsOnWays, AreWhereOthersDrivePastTheQueue) {
  RoadNetwork road;
  add_road(road, "a", {0, 0}, "b", {12, 0}, {{5, 0}, {5.2, 0}});
  add_road(road, "w", {-50, 0}, "a", {0, 0}, {{-50, 0}, {-10, 0}});
  add_road(road, "b", {12, 0}, "e", {60, 0}, {{20, 0}, {60, 0}});
  add_road(road, "s", {12, -50}, "b", {12, 0}, {{12, -50}, {12, -10}});
  add_road(road, "b", {12, 0}, "n", {-5, 50}, {{-1, 10}, {-5, 50}});
  add_link(road, 1, 0, {{-10, 0}, {5, 0}});
  add_link(road, 0, 2, {{5.2, 0}, {20, 0}});
  EXPECT_THAT(signals_on_ways(road), IsEmpty()) << "nobody turns";
  add_link(road, 3, 4, {{12, -10}, {2, -1}, {-1, 10}});  // over the queue that comes from w
  EXPECT_THAT(signals_on_ways(road), IsEmpty()) << "no signal";
  road.junctions[1].type = "traffic_light";
  EXPECT_THAT(signals_on_ways(road), ElementsAre(ElementsAre("a", "b")));
  RoadNetwork beside = road;
  beside.lanes.back().centerline = Polyline({{12, -10}, {8, 5}, {-1, 10}});
  EXPECT_THAT(signals_on_ways(beside), IsEmpty()) << "the turn keeps clear of the queue";
  road.lanes[0].centerline = Polyline({{3, 0}, {9, 0}});
  EXPECT_THAT(signals_on_ways(road), IsEmpty()) << "the queue has room of its own";
}

TEST(SwallowedRoads, OnesThatMeetMakeOneJunctionAndClustersAreTheirNodes) {
  RoadNetwork road;
  add_road(road, "a", {0, 0}, "b", {3, 0}, {{-8, 0}, {-0.5, 0}});
  add_road(road, "x", {70, 0}, "y", {73, 0}, {{62, 0}, {69, 0}});
  add_road(road, "b", {3, 0}, "cluster_c_d_#2more", {6, 0}, {{7, 0}, {9, 0}});
  EXPECT_THAT(swallowed_roads(road),
              ElementsAre(ElementsAre("x", "y"), ElementsAre("a", "b", "c", "d")));
}

// joins that netconvert made by itself, and one that is to be made besides
TEST(AddGroup, TakesInWhatItMeets) {
  std::vector<NodeGroup> joins = {{"c", "d", "e"}, {"g", "h"}, {"b", "i"}};
  add_group({"a", "b", "c"}, joins);
  EXPECT_THAT(joins, ElementsAre(ElementsAre("g", "h"), ElementsAre("a", "b", "c", "d", "e", "i")));
}

}  // namespace
}  // namespace sumogamma::osm
