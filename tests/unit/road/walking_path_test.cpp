#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "road/lane_locator.h"
#include "road/path.h"
#include "road/stop_lines.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using ::testing::HasSubstr;
using testing::read_plain_net;
using testing::route_of;

class WalkingPath : public ::testing::TestWithParam<bool> {
 protected:
  const RoadNetwork& network() const {
    static const RoadNetwork right =
        read_plain_net(crossroads("traffic_light", {"--sidewalks.guess", "--crossings.guess"}));
    static const RoadNetwork left = read_plain_net(
        crossroads("traffic_light", {"--sidewalks.guess", "--crossings.guess", "--lefthand"}));
    return GetParam() ? left : right;
  }
  std::optional<Path> walk(const std::vector<std::string>& names, std::string& why,
                           double start = 0, double arrival = -1, double mid_block = -1) const {
    const std::vector<EdgeId> route = route_of(network(), names);
    PathRequest request;
    request.route = route;
    request.vehicle_class = vehicle_class::kPedestrian;
    request.start_along = start;
    request.arrival_position = arrival;
    request.max_speed = 3;
    request.mid_block = mid_block;
    return build_walking_path(network(), request, why);
  }
  /// Calls `visit` with each link of three walks and the way from where people wait before it to
  /// the middle of the nearest way of vehicles [m].
  template <typename Visit>
  void visit_waiting_places(Visit visit) const {
    std::string why;
    for (const auto& names : {std::vector<std::string>{"SC", "CN"}, {"WC", "CE"}, {"NC", "CW"}}) {
      const auto path = walk(names, why);
      ASSERT_TRUE(path) << why;
      for (const PathLink& link : path->links) {
        const double side = std::clamp(0.0, link.halt_right, link.halt_left);
        const Vec2 place =
            path->line.point_at(link.halt) + side * left_of(path->line.direction_at(link.halt));
        double room = std::numeric_limits<double>::infinity();
        for (const Lane& lane : network().lanes)
          if (lane.kind == LaneKind::Internal && (lane.allowed & vehicle_class::kPassenger) != 0)
            room = std::min(room, lane.centerline.project(place).distance);
        visit(link, room);
      }
    }
  }
  const Lane& lane_at(const Path& path, double along) const {
    return network().lane(path.stretch_at(along).lane);
  }
};

TEST_P(WalkingPath, StaysOnTheSidewalkOfOneEdge) {
  std::string why;
  const auto path = walk({"WC"}, why, 20, 120);
  ASSERT_TRUE(path) << why;
  EXPECT_TRUE(path->walking);
  EXPECT_NEAR(path->line.length(), 100, 1e-6);
  EXPECT_EQ(lane_at(*path, 50).name, "WC_0");
  EXPECT_FALSE(path->stretches.front().reversed);
  EXPECT_NEAR(path->stretches.front().room_left, 0.5 * lane_at(*path, 50).width, 1e-9);
  EXPECT_TRUE(path->links.empty());
}

/// Room to either side on an edge of its own [m].
double room_on(const std::string& lane) {
  testing::PlainNet plain;
  plain.nodes = "<node id='W' x='0' y='0'/><node id='E' x='60' y='0'/>";
  plain.edges = "<edge id='way' from='W' to='E' numLanes='1' " + lane + "/>";
  const RoadNetwork network = read_plain_net(plain);
  PathRequest request;
  const std::vector<EdgeId> route = route_of(network, {"way"});
  request.route = route;
  request.vehicle_class = vehicle_class::kPedestrian;
  std::string why;
  const auto path = build_walking_path(network, request, why);
  EXPECT_TRUE(path) << why;
  const PathStretch& stretch = path->stretches.front();
  EXPECT_EQ(stretch.room_left, stretch.room_right);
  return stretch.room_left;
}

TEST(WalkingRoom, TwoWhoMeetOnANarrowPathHaveTheVerge) {
  EXPECT_GE(room_on("allow='pedestrian' width='0.8'"), 0.6);  // two bodies and their margins
  EXPECT_NEAR(room_on("allow='pedestrian' width='2.0'"), 1.0, 1e-9);
}

TEST(WalkingRoom, WhoMeetsAVehicleOnASharedLaneStepsAside) {
  EXPECT_GT(room_on("allow='pedestrian delivery' width='3.0'"), 1.5 + 0.9);
  EXPECT_GT(room_on("allow='pedestrian bicycle' width='1.0'"), 0.5 + 0.9);
}

TEST_P(WalkingPath, WalksBackwardsToAnArrivalBehindTheStart) {
  std::string why;
  const auto path = walk({"WC"}, why, 120, 20);
  ASSERT_TRUE(path) << why;
  EXPECT_NEAR(path->line.length(), 100, 1e-6);
  EXPECT_TRUE(path->stretches.front().reversed);
  EXPECT_NEAR(path->line.direction_at(10).x(), -1.0, 1e-9);
}

/// Crossings on a path in order, each checked: entered at its stop line, walked from end to end.
int count_crossings(const RoadNetwork& network, const Path& path, int& reversed) {
  reversed = 0;
  for (const PathLink& link : path.links) {
    const PathStretch& stretch = path.stretch_at(0.5 * (link.stop_line + link.end));
    const Lane& lane = network.lane(stretch.lane);
    EXPECT_EQ(lane.kind, LaneKind::Crossing);
    EXPECT_NEAR(link.stop_line, stretch.from, 1e-6);
    EXPECT_NEAR(link.end, stretch.to, 1e-6);
    EXPECT_NEAR(stretch.to - stretch.from, lane.centerline.length(), 1e-6);
    const Vec2 entry = path.line.point_at(link.stop_line);
    const Vec2 end =
        stretch.reversed ? lane.centerline.points().back() : lane.centerline.points().front();
    EXPECT_NEAR((entry - end).norm(), 0.0, 1e-6);
    EXPECT_GE(network.connection(link.connection).junction_link, 0);
    EXPECT_NE(network.connection(link.connection).signal, kNoSignal);
    reversed += stretch.reversed;
  }
  return static_cast<int>(path.links.size());
}

TEST_P(WalkingPath, CrossesInBothDirections) {
  // round the junction, each arm's sidewalk to the one across its road and back
  const std::vector<std::pair<std::string, std::string>> across = {
      {"WC", "CW"}, {"EC", "CE"}, {"NC", "CN"}, {"SC", "CS"}};
  int all_reversed = 0, all_forward = 0;
  for (const auto& [from, to] : across)
    for (const bool back : {false, true}) {
      std::string why;
      const auto path = back ? walk({to, from}, why, 5, 190) : walk({from, to}, why, 100, 5);
      ASSERT_TRUE(path) << from << (back ? " back: " : " on: ") << why;
      int reversed = 0;
      const int crossings = count_crossings(network(), *path, reversed);
      EXPECT_EQ(crossings, 1) << from << " " << back;
      all_reversed += reversed;
      all_forward += crossings - reversed;
    }
  // of the two directions of one crossing exactly one goes against its lane
  EXPECT_EQ(all_reversed, 4);
  EXPECT_EQ(all_forward, 4);
}

TEST_P(WalkingPath, HasNoGapAndNoDetour) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"WC", "CE"}, {"WC", "CN"}, {"WC", "CS"}, {"SC", "CN"}, {"EC", "CS"}}) {
    std::string why;
    const auto path = walk({from, to}, why, 150, 50);
    ASSERT_TRUE(path) << from << to << why;
    EXPECT_NEAR(path->stretches.front().from, 0.0, 1e-9);
    for (std::size_t i = 0; i + 1 < path->stretches.size(); ++i)
      EXPECT_NEAR(path->stretches[i].to, path->stretches[i + 1].from, 1e-6);
    EXPECT_NEAR(path->stretches.back().to, path->line.length(), 1e-9);
    // 40-odd metres to the junction, the junction (two crossings at most), 50-odd metres from it
    EXPECT_LT(path->line.length(), 170) << from << to;
    EXPECT_LE(path->links.size(), 2u);
  }
}

// in a walking area somebody went round a bicycle that stood there, over the kerb, at red
TEST_P(WalkingPath, AreasAreOpenGroundAsFarAsTheirKerb) {
  std::string why;
  const auto path = walk({"WC", "CE"}, why, 100, 50);
  ASSERT_TRUE(path) << why;
  int at_kerb = 0;
  for (const PathStretch& stretch : path->stretches) {
    const Lane& area = network().lane(stretch.lane);
    if (area.kind != LaneKind::WalkingArea) continue;
    EXPECT_LE(stretch.to - stretch.from, 1.0 + 1e-9);
    const double middle = 0.5 * (stretch.from + stretch.to);
    const Vec2 here = path->line.point_at(middle), left = left_of(path->line.direction_at(middle));
    for (const double room : {stretch.room_left, -stretch.room_right}) {
      EXPECT_GE(std::abs(room), 0.75) << "two get past each other";
      if (std::abs(room) == 0.75 || std::isinf(room)) continue;  // infinite on the crossing already
      EXPECT_LT(distance_to_ring(area.outline, here + room * left), 1e-6);
      EXPECT_TRUE(ring_contains(area.outline, here + 0.99 * room * left));
      ++at_kerb;
    }
  }
  EXPECT_GE(at_kerb, 4);
}

TEST_P(WalkingPath, EdgesOfTheJunctionInAWalkAreFoundAnew) {
  std::string why;
  const auto plain = walk({"WC", "CE"}, why, 100, 50);
  std::vector<std::string> names = {"WC"};
  for (const Edge& edge : network().edges)
    if (edge.kind == LaneKind::WalkingArea && edge.name.find(":C") == 0) names.push_back(edge.name);
  names.push_back("CE");
  const auto with_areas = walk(names, why, 100, 50);
  ASSERT_TRUE(plain && with_areas) << why;
  EXPECT_EQ(plain->line.points(), with_areas->line.points());
}

TEST_P(WalkingPath, TakesTheNearerEndForWhereItArrives) {
  // from the middle of one side to the junction end of the other: over the crossing at C, not round
  // by the far end
  std::string why;
  const auto path = walk({"WC", "CW"}, why, 100, 5);
  ASSERT_TRUE(path) << why;
  EXPECT_LT(path->line.length(), 130);
}

TEST_P(WalkingPath, WaitsWhereNobodyDrives) {
  visit_waiting_places([&](const PathLink& link, double room) {
    EXPECT_LE(link.halt, link.stop_line);
    EXPECT_GT(room, 1.5);
  });
}

// lorries crept past people who stood 1.55 m from the middle of their way
TEST_P(WalkingPath, WaitsAStepFurtherBackWhereThatLeavesDriversRoom) {
  visit_waiting_places([&](const PathLink& link, double room) {
    EXPECT_LE(link.stop_line - link.halt, 0.8 + 1e-9);
    EXPECT_GT(room, 2.1);
  });
}

// drivers wait at a zebra for whoever is at the kerb, and waited twice as long
TEST(WalkingPathWithoutSignals, WaitsRightBesideTheWays) {
  const auto way_back = [](const char* type) {
    const RoadNetwork network =
        read_plain_net(crossroads(type, {"--sidewalks.guess", "--crossings.guess"}));
    const std::vector<EdgeId> route = route_of(network, {"SC", "CN"});
    PathRequest request;
    request.route = route;
    request.vehicle_class = vehicle_class::kPedestrian;
    std::string why;
    const auto path = build_walking_path(network, request, why);
    EXPECT_TRUE(path && !path->links.empty()) << why;
    return path->links.front().stop_line - path->links.front().halt;
  };
  EXPECT_LT(way_back("priority"), way_back("traffic_light") - 0.3);
}

// who had crossed one half of a road went back over it to wait for the other half
TEST_P(WalkingPath, NobodyGoesBackOverACrossingToWaitForTheNext) {
  std::string why;
  auto path = walk({"SC", "CN"}, why);
  ASSERT_TRUE(path) << why;
  ASSERT_GE(path->links.size(), 1u);
  // the second half begins where the first ends, amid the road
  PathLink first = path->links.front(), second = first;
  first.end = second.stop_line = 0.5 * (first.stop_line + first.end);
  path->links = {first, second};
  halt_off_the_road(network(), *path);
  EXPECT_LT(path->links[0].halt, first.stop_line + 1e-9);
  EXPECT_GE(path->links[1].halt, first.end);
}

/// How far from the sidewalk's middle a place of a path is [m].
double off_sidewalk(const RoadNetwork& network, const std::string& lane, const Path& path,
                    double along) {
  return network.lane(network.lane_by_name.at(lane))
      .centerline.project(path.line.point_at(along))
      .distance;
}

TEST_P(WalkingPath, WhoCrossesBetweenJunctionsIsOnTheOtherSidewalkThen) {
  for (const double draw : {0.0, 0.3, 0.99}) {
    // two crossings away, or across the road that they walk along
    for (const std::string to : {"CN", "CS", "CE", "CW"}) {
      std::string why;
      const double arrival = to == "CW" ? 5 : 150;
      const auto path = walk({"WC", to}, why, 20, arrival, draw);
      const auto kept = walk({"WC", to}, why, 20, arrival);
      ASSERT_TRUE(path && kept) << to << why;
      EXPECT_TRUE(kept->over_road.empty());
      const bool needs_it =
          std::any_of(kept->stretches.begin(), kept->stretches.end(), [&](const PathStretch& s) {
            const auto& crossed = network().edge(network().lane(s.lane).edge).crossing_edges;
            return std::find(crossed.begin(), crossed.end(), network().edge_by_name.at("WC")) !=
                   crossed.end();
          });
      ASSERT_EQ(path->over_road.size(), needs_it ? 1u : 0u) << to << " " << draw;
      if (!needs_it) {
        EXPECT_EQ(path->line.points(), kept->line.points());
        continue;
      }
      const RoadCrossing& over = path->over_road.front();
      const Vec2 begin = path->line.point_at(over.begin), end = path->line.point_at(over.end);
      // far from the ends, straight over the road from edge to edge
      EXPECT_GT(begin.x(), -200 + 15 - 1e-6);
      EXPECT_LT(begin.x(), -15);
      EXPECT_NEAR(begin.x(), end.x(), 1e-6);
      EXPECT_NEAR((end - begin).norm(), over.end - over.begin, 1e-6);
      EXPECT_NEAR(off_sidewalk(network(), "WC_0", *path, over.begin), 1.0, 1e-6);
      EXPECT_NEAR(off_sidewalk(network(), "CW_0", *path, over.end), 1.0, 1e-6);
      EXPECT_NEAR(off_sidewalk(network(), "CW_0", *path, over.end + 2.0), 0.0, 1e-6);
      EXPECT_LT(path->line.length(), kept->line.length() + 5.0) << to;
      EXPECT_EQ(path->links.size() + 1, kept->links.size()) << to << " saves one crossing";
      for (std::size_t i = 0; i + 1 < path->stretches.size(); ++i)
        EXPECT_NEAR(path->stretches[i].to, path->stretches[i + 1].from, 1e-6);
      // who is on the road is on the one sidewalk or the other for those who ask for its lane
      EXPECT_EQ(lane_at(*path, over.begin + 0.5).name, "WC_0");
      EXPECT_EQ(lane_at(*path, over.end - 0.5).name, "CW_0");
    }
  }
}

TEST_P(WalkingPath, WhereToCrossBetweenJunctionsIsDrawn) {
  std::string why;
  const auto soon = walk({"WC", "CW"}, why, 20, 5, 0.0), late = walk({"WC", "CW"}, why, 20, 5, 0.9);
  ASSERT_TRUE(soon && late) << why;
  ASSERT_EQ(soon->over_road.size() * late->over_road.size(), 1u);
  EXPECT_LT(soon->over_road.front().begin + 50, late->over_road.front().begin);
}

TEST_P(WalkingPath, NobodyWalksOnBeyondWhereItArrivesAcross) {
  std::string why;
  // across is 30 m further on, and 60 m back
  for (const auto& [arrival, most] : {std::pair{200.0 - 130.0, 70.0}, {200.0 - 40.0, 120.0}}) {
    const auto path = walk({"WC", "CW"}, why, 100, arrival, 0.99);
    ASSERT_TRUE(path) << why;
    ASSERT_EQ(path->over_road.size(), 1u) << arrival;
    EXPECT_LT(path->line.length(), most) << arrival;
  }
}

TEST_P(WalkingPath, NobodyCrossesNearAJunctionOrThroughAFence) {
  std::string why;
  const double end = network().lane(network().lane_by_name.at("WC_0")).centerline.length();
  const auto late = walk({"WC", "CW"}, why, end - 16, 5, 0.5);
  ASSERT_TRUE(late) << why;
  EXPECT_TRUE(late->over_road.empty());
  RoadNetwork fenced = network();
  fenced.obstacles.push_back({ObstacleKind::Barrier, {Vec2(-200, 0), Vec2(-10, 0)}});
  PathRequest request;
  const std::vector<EdgeId> route = route_of(fenced, {"WC", "CW"});
  request.route = route;
  request.vehicle_class = vehicle_class::kPedestrian;
  request.arrival_position = 5;
  request.mid_block = 0.5;
  const auto kept = build_walking_path(fenced, request, why);
  ASSERT_TRUE(kept) << why;
  EXPECT_TRUE(kept->over_road.empty());
}

TEST_P(WalkingPath, AnEmptyWalkSaysWhy) {
  std::string why;
  EXPECT_FALSE(walk({}, why));
  EXPECT_THAT(why, HasSubstr("no edges"));
}

TEST(WalkingPathWithoutSidewalk, SaysWhichEdge) {
  const RoadNetwork network = read_plain_net(crossroads("priority"));
  std::string why;
  PathRequest request;
  const std::vector<EdgeId> route = route_of(network, {"CE", "CN"});
  request.route = route;
  // pedestrians may use the lanes, but nothing connects the edges on foot
  EXPECT_FALSE(build_walking_path(network, request, why));
  EXPECT_THAT(why, HasSubstr("no way on foot from edge 'CE' to edge 'CN'"));
  RoadNetwork cars_only = network;
  for (Lane& lane : cars_only.lanes) lane.allowed = vehicle_class::kPassenger;
  EXPECT_FALSE(build_walking_path(cars_only, request, why));
  EXPECT_THAT(why, HasSubstr("edge 'CE' has no lane for pedestrians"));
}

INSTANTIATE_TEST_SUITE_P(Hands, WalkingPath, ::testing::Bool(),
                         [](const auto& row) { return row.param ? "Left" : "Right"; });

}  // namespace
}  // namespace sumogamma
