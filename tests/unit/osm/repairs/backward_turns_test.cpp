#include "osm/repairs/backward_turns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/small_net.h"

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The way from "in" to "out" of the small network, drawn otherwise.
RoadNetwork with_way(std::vector<Vec2> points) {
  RoadNetwork road = sumogamma::testing::small_net();
  road.lanes[index_of(road.lane_by_name.at(":C_0_0"))].centerline = Polyline(std::move(points));
  return road;
}

TEST(BackwardTurns, BeginBehindTheEndOfTheirLane) {
  EXPECT_THAT(backward_turns(with_way({{95, 0}, {105, 0}})), IsEmpty());
  EXPECT_THAT(backward_turns(with_way({{95, 0}, {96, 3}, {90, 9}})), IsEmpty())
      << "sharp, but begins ahead";
  EXPECT_THAT(backward_turns(with_way({{95, 0}, {94.5, 3}})), IsEmpty()) << "half a metre back";
  const RoadNetwork road = with_way({{95, 0}, {70, 1}});
  const std::vector<ConnectionId> turns = backward_turns(road);
  ASSERT_EQ(turns.size(), 1u);
  const Turn turn = named_turn(road, turns[0]);
  EXPECT_EQ(turn.from, "in");
  EXPECT_EQ(turn.to, "out");
  EXPECT_EQ(turn.from_lane, 1);
  EXPECT_EQ(turn.to_lane, 0);
}

TEST(DispensableTurns, HaveAnotherWayFromALaneThatLeadsOn) {
  RoadNetwork road = with_way({{95, 0}, {70, 1}});
  const std::vector<ConnectionId> turns = backward_turns(road);
  EXPECT_THAT(dispensable_turns(road, turns), IsEmpty()) << "the only way";
  // from "in" to "back", and from there to "out"
  const auto connect = [&](const char* from, const char* to) {
    Connection made = road.connection(turns[0]);
    made.from = road.lane_by_name.at(from);
    made.to = road.lane_by_name.at(to);
    const ConnectionId id{static_cast<int>(road.connections.size())};
    road.connections.push_back(made);
    road.lanes[index_of(made.from)].outgoing.push_back(id);
  };
  connect("in_1", "back_0");
  EXPECT_THAT(dispensable_turns(road, turns), IsEmpty()) << "leads elsewhere";
  connect("back_0", "out_0");
  EXPECT_THAT(dispensable_turns(road, turns), ElementsAre(turns[0]));
}

}  // namespace
}  // namespace sumogamma::osm
