#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "road/lane_locator.h"
#include "road/path.h"
#include "road/path_pieces.h"
#include "road/replan.h"
#include "road/smoothing.h"
#include "road/speed_profile.h"
#include "support/plain_net.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using ::testing::HasSubstr;
using testing::PlainNet;
using testing::read_plain_net;
using testing::route_of;

const std::vector<std::string> kSidewalks = {"--sidewalks.guess", "--crossings.guess"};

PathRequest request_of(const std::vector<EdgeId>& route,
                       VehicleClassMask vehicle_class = vehicle_class::kPassenger) {
  PathRequest request;
  request.route = route;
  request.vehicle_class = vehicle_class;
  return request;
}

Path path_along(const RoadNetwork& network, const std::vector<std::string>& names,
                const std::string& start_lane = "", double start_along = 0,
                double turning_radius = 0) {
  const std::vector<EdgeId> route = route_of(network, names);
  PathRequest request = request_of(route);
  if (!start_lane.empty()) request.start_lane = network.lane_by_name.at(start_lane);
  request.start_along = start_along;
  request.cornering.turning_radius = turning_radius;
  std::string why;
  std::optional<Path> path = build_driving_path(network, request, why);
  if (!path) throw std::runtime_error("no path: " + why);
  return *path;
}

/// What every path must obey, whatever it was made from.
void expect_sound(const Path& path) {
  ASSERT_FALSE(path.stretches.empty());
  EXPECT_NEAR(path.stretches.front().from, 0.0, 1e-9);
  EXPECT_NEAR(path.stretches.back().to, path.line.length(), 1e-6);
  for (std::size_t i = 0; i + 1 < path.stretches.size(); ++i)
    EXPECT_NEAR(path.stretches[i].to, path.stretches[i + 1].from, 1e-6) << "gap after " << i;
  for (std::size_t i = 0; i + 1 < path.links.size(); ++i)
    EXPECT_LE(path.links[i].end, path.links[i + 1].stop_line + 1e-9);
  for (const PathLink& link : path.links) EXPECT_LE(link.stop_line, link.end);
  for (const double speed : path.speed_profile.unpacked()) EXPECT_GT(speed, 0.0);
  EXPECT_LE(path.arrival, path.line.length() + 1e-9);
}

/// Sharpest turn between two neighbouring pieces [rad]: a path that doubles back shows pi.
double sharpest_turn(const Path& path) {
  double sharpest = 0.0;
  const auto& points = path.line.points();
  for (std::size_t i = 2; i < points.size(); ++i)
    sharpest = std::max(sharpest, std::abs(wrap_angle(heading_of(points[i] - points[i - 1]) -
                                                      heading_of(points[i - 1] - points[i - 2]))));
  return sharpest;
}

std::vector<std::string> lanes_of(const RoadNetwork& network, const Path& path) {
  std::vector<std::string> names;
  for (const PathStretch& stretch : path.stretches) {
    const Lane& lane = network.lane(stretch.lane);
    if (lane.kind != LaneKind::Normal) continue;
    if (names.empty() || names.back() != lane.name) names.push_back(lane.name);
  }
  return names;
}

class Crossroads : public ::testing::Test {
 protected:
  static const RoadNetwork& right() {
    static const RoadNetwork network = read_plain_net(crossroads("priority", kSidewalks));
    return network;
  }
  static const RoadNetwork& left() {
    static const RoadNetwork network = read_plain_net(
        crossroads("priority", {"--sidewalks.guess", "--crossings.guess", "--lefthand"}));
    return network;
  }
};

TEST_F(Crossroads, StraightOnKeepsTheLane) {
  const Path path = path_along(right(), {"WC", "CE"}, "WC_1");
  expect_sound(path);
  EXPECT_EQ(lanes_of(right(), path), (std::vector<std::string>{"WC_1", "CE_1"}));
  ASSERT_EQ(path.links.size(), 1u);
  const Lane& lane = right().lane(right().lane_by_name.at("WC_1"));
  // the stop line is where the lane ends and the junction begins
  EXPECT_NEAR(
      (path.line.point_at(path.links[0].stop_line) - lane.centerline.points().back()).norm(), 0.0,
      1e-6);
  const Lane& target = right().lane(right().lane_by_name.at("CE_1"));
  EXPECT_NEAR((path.line.point_at(path.links[0].end) - target.centerline.points().front()).norm(),
              0.0, 1e-6);
  EXPECT_EQ(right().connection(path.links[0].connection).direction, TurnDirection::Straight);
}

TEST_F(Crossroads, ATurnThatNeedsTheOtherLaneChangesBeforeTheStopLine) {
  // lane 0 is the sidewalk; only the inner lane 2 leads to the left
  const Path path = path_along(right(), {"WC", "CN"}, "WC_1");
  expect_sound(path);
  EXPECT_EQ(lanes_of(right(), path), (std::vector<std::string>{"WC_1", "WC_2", "CN_1"}));
  ASSERT_EQ(path.links.size(), 1u);
  const Lane& inner = right().lane(right().lane_by_name.at("WC_2"));
  EXPECT_NEAR(
      (path.line.point_at(path.links[0].stop_line) - inner.centerline.points().back()).norm(), 0.0,
      1e-6);
  // a change is a gentle S, not a jump aside
  EXPECT_LT(sharpest_turn(path), radians(30));
}

// SUMO's lane changes are jumps: the path follows the lane on which SUMO has a vehicle
TEST_F(Crossroads, GoesOnFromTheLaneThatItHasBeenPutOnto) {
  const Path path = path_along(right(), {"WC", "CE"}, "WC_1");
  const auto lane = [&](const char* name) { return right().lane_by_name.at(name); };
  const auto beside = go_on_from({right(), path, 30.0, 20.0}, {lane("WC_2"), kNoConnection, 30.0});
  ASSERT_TRUE(beside);
  expect_sound(beside->path);
  EXPECT_EQ(lanes_of(right(), beside->path).front(), "WC_2");
  EXPECT_NEAR(beside->along, 20.0, 1e-9);
  EXPECT_NEAR((beside->path.line.point_at(beside->along) -
               right().lane(lane("WC_2")).centerline.point_at(30.0))
                  .norm(),
              0.0, 1e-6);
  EXPECT_EQ(beside->path.trip, path.trip);
  // on the link that leads elsewhere than the path's
  const Connection& straight = right().connection(path.links.front().connection);
  const double end = right().lane(lane("WC_1")).centerline.length();
  const auto inside = go_on_from({right(), path, path.links.front().stop_line + 3.0, 20.0},
                                 {straight.from, path.links.front().connection, end + 3.0});
  ASSERT_TRUE(inside);
  expect_sound(inside->path);
  EXPECT_EQ(inside->path.links.front().connection, path.links.front().connection);
  EXPECT_NEAR(inside->along, inside->path.links.front().stop_line + 3.0, 0.5);
  // not on its route
  EXPECT_FALSE(go_on_from({right(), path, 30.0, 20.0}, {lane("NC_1"), kNoConnection, 30.0}));
}

TEST_F(Crossroads, WhoIsTooLateForItsTurnGoesOnToTheEndOfItsLane) {
  const Path path = path_along(right(), {"WC", "CN"}, "WC_2");
  const LaneId outer = right().lane_by_name.at("WC_1");
  const double end = right().lane(outer).centerline.length();
  const auto late = go_on_from({right(), path, end - 3.0, 20.0}, {outer, kNoConnection, end - 3.0});
  ASSERT_TRUE(late);
  EXPECT_EQ(lanes_of(right(), late->path), std::vector<std::string>{"WC_1"});
}

TEST_F(Crossroads, TakesTheBestLaneWhereNoneIsGiven) {
  EXPECT_EQ(lanes_of(right(), path_along(right(), {"WC", "CN"})),
            (std::vector<std::string>{"WC_2", "CN_1"}));
  EXPECT_EQ(lanes_of(right(), path_along(right(), {"WC", "CS"})),
            (std::vector<std::string>{"WC_1", "CS_1"}));
}

// netconvert ends links of bicycles up to a metre beside the lane that they lead into: a bicycle
// rode that step out as a hook, two metres aside, before a motorcycle
TEST(Links, AreLedOverToTheLanesThatTheyJoin) {
  RoadNetwork network = testing::small_net();
  Lane& link = network.lanes[index_of(network.lane_by_name.at(":C_0_0"))];
  link.centerline = Polyline({{95, -0.8}, {105, 1.1}});
  const Path path = path_along(network, {"in", "out"});
  expect_sound(path);
  for (double x = 90; x < 110; x += 0.5) {
    const PolylinePosition place = path.line.project(Vec2(x, 0.0));
    EXPECT_GT(path.line.direction_at(place.along).x(), 0.8) << "no step, at " << x;
  }
  EXPECT_NEAR(path.line.point_at(path.links.front().end).y(), 0.0, 0.1);
  // what is as far beside as a lane is wide is no slip of netconvert's
  link.centerline = Polyline({{95, 0}, {105, 3.2}});
  const Path other = path_along(network, {"in", "out"});
  EXPECT_NEAR(other.line.point_at(other.links.front().end).y(), 3.2, 0.1);
}

TEST(DrivingPath, ALeftTurnMayWaitOnASignalledJunctionAndStraightOnMayNot) {
  const RoadNetwork network = read_plain_net(crossroads("traffic_light"));
  auto link_of = [&](const std::vector<std::string>& names) {
    const std::vector<EdgeId> route = testing::route_of(network, names);
    PathRequest request;
    request.route = route;
    request.vehicle_class = vehicle_class::kPassenger;
    std::string why;
    return build_driving_path(network, request, why)->links.front();
  };
  const PathLink left = link_of({"SC", "CW"}), straight = link_of({"SC", "CN"});
  EXPECT_GT(left.inside, left.stop_line + 2.0);
  EXPECT_LT(left.inside, left.end - 2.0);
  EXPECT_NEAR(straight.inside, straight.stop_line, 1e-6);
}

TEST_F(Crossroads, StartsAndArrivesWhereAsked) {
  const std::vector<EdgeId> route = route_of(right(), {"WC", "CE"});
  PathRequest request = request_of(route);
  request.start_lane = right().lane_by_name.at("WC_1");
  request.start_along = 50;
  request.arrival_position = 30;
  std::string why;
  const auto path = build_driving_path(right(), request, why);
  ASSERT_TRUE(path) << why;
  const Lane& first = right().lane(request.start_lane);
  const Lane& last = right().lane(path->stretches.back().lane);
  EXPECT_NEAR((path->line.point_at(0) - first.centerline.point_at(50)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((path->line.point_at(path->arrival) - last.centerline.point_at(30)).norm(), 0.0,
              1e-6);
}

TEST_F(Crossroads, AnArrivalBehindTheStartIsReachedAtOnce) {
  const std::vector<EdgeId> route = route_of(right(), {"WC"});
  PathRequest request = request_of(route);
  request.start_along = 80;
  request.arrival_position = 30;
  std::string why;
  const auto path = build_driving_path(right(), request, why);
  ASSERT_TRUE(path) << why;
  EXPECT_NEAR(path->arrival, 0.0, 1e-9);
  EXPECT_FALSE(path->speed_profile.empty());
}

TEST_F(Crossroads, AnImpossibleRouteSaysWhy) {
  std::string why;
  const std::vector<EdgeId> backwards = route_of(right(), {"WC", "WC"});
  EXPECT_FALSE(build_driving_path(right(), request_of(backwards), why));
  EXPECT_THAT(why, HasSubstr("WC"));
  const std::vector<EdgeId> apart = route_of(right(), {"CE", "CN"});
  EXPECT_FALSE(build_driving_path(right(), request_of(apart), why));
  EXPECT_THAT(why, HasSubstr("CN"));
  const std::vector<EdgeId> none;
  EXPECT_FALSE(build_driving_path(right(), request_of(none), why));
  EXPECT_THAT(why, HasSubstr("no edges"));
  // the lanes are there, but not for trains
  const std::vector<EdgeId> through = route_of(right(), {"WC", "CE"});
  EXPECT_FALSE(build_driving_path(right(), request_of(through, vehicle_class::kPedestrian), why));
}

TEST_F(Crossroads, RoomEndsWhereTheClassMayNotGo) {
  // right-hand: kerb to the right of lane 1, lane 2 to its left
  const Path outer = path_along(right(), {"WC", "CE"}, "WC_1");
  const double width = right().lane(right().lane_by_name.at("WC_1")).width;
  EXPECT_NEAR(outer.stretches.front().room_right, 0.5 * width, 1e-9);
  EXPECT_NEAR(outer.stretches.front().room_left, 1.5 * width, 1e-9);
  const Path inner = path_along(right(), {"WC", "CE"}, "WC_2");
  EXPECT_NEAR(inner.stretches.front().room_right, 1.5 * width, 1e-9);
  EXPECT_NEAR(inner.stretches.front().room_left, 0.5 * width, 1e-9);
}

// who rode round somebody beside its way came out on the wrong side of a queue on a path of 1 m
TEST(JunctionRoom, BicyclesKeepToTheirWay) {
  PlainNet plain = crossroads("priority");
  const std::string any = "speed=\"13\"";
  for (std::size_t at = plain.edges.find(any); at != std::string::npos;
       at = plain.edges.find(any, at + 1))
    plain.edges.replace(at, any.size(), "speed=\"5\" width=\"1\" allow=\"bicycle\"");
  const RoadNetwork network = read_plain_net(plain);
  int links = 0;
  for (const Lane& lane : network.lanes) {
    if (lane.kind != LaneKind::Internal) continue;
    ++links;
    EXPECT_EQ(lane.beside_left, 0.0) << lane.name;
    EXPECT_EQ(lane.beside_right, 0.0) << lane.name;
  }
  EXPECT_GT(links, 0);
}

TEST_F(Crossroads, RoomOnAJunctionEndsWherePeopleWalk) {
  const LaneLocator locator(right());
  std::vector<LaneHit> hits;
  int narrowed = 0, widened = 0;
  for (const Lane& lane : right().lanes) {
    if (lane.kind != LaneKind::Internal) continue;
    for (const double side : {1.0, -1.0}) {
      const double beside = side > 0 ? lane.beside_left : lane.beside_right;
      ASSERT_GE(beside, 0.0);
      ASSERT_LE(beside, 1.5);
      (beside < 1.5 ? narrowed : widened) += 1;
      for (double along = 0; along <= lane.centerline.length(); along += 2.0) {
        const Vec2 edge =
            lane.centerline.point_at(along) +
            side * (0.5 * lane.width + beside) * left_of(lane.centerline.direction_at(along));
        locator.find_containing(edge, hits);
        const bool walkway = !hits.empty() && std::all_of(hits.begin(), hits.end(), [](auto& hit) {
          return right().lane(hit.lane).kind == LaneKind::WalkingArea;
        });
        EXPECT_TRUE(beside == 0.0 || !walkway) << lane.name << " at " << along;
      }
    }
  }
  EXPECT_GT(narrowed, 0);
  EXPECT_GT(widened, 0);
}

TEST_F(Crossroads, RoomIsMirroredWhereTrafficKeepsLeft) {
  ASSERT_TRUE(left().left_hand);
  const Path outer = path_along(left(), {"WC", "CE"}, "WC_1");
  const double width = left().lane(left().lane_by_name.at("WC_1")).width;
  EXPECT_NEAR(outer.stretches.front().room_left, 0.5 * width, 1e-9);
  EXPECT_NEAR(outer.stretches.front().room_right, 1.5 * width, 1e-9);
  // the lane beside lies on that side in fact
  const Vec2 lane_1 = left().lane(left().lane_by_name.at("WC_1")).centerline.point_at(50);
  const Vec2 lane_2 = left().lane(left().lane_by_name.at("WC_2")).centerline.point_at(50);
  EXPECT_LT((lane_2 - lane_1).dot(left_of(outer.line.direction_at(50))), 0.0);
}

TEST_F(Crossroads, RoomDuringALaneChangeStaysOnTheRoad) {
  for (const auto* network : {&right(), &left()}) {
    const Path path = path_along(*network, {"WC", network->left_hand ? "CS" : "CN"}, "WC_1");
    const Lane& outer = network->lane(network->lane_by_name.at("WC_1"));
    const Lane& inner = network->lane(network->lane_by_name.at("WC_2"));
    for (double along = 0; along < path.links.front().stop_line; along += 1.0) {
      const PathStretch& stretch = path.stretch_at(along);
      const Vec2 place = path.line.point_at(along);
      const Vec2 left_side = left_of(Vec2(1, 0));
      const Vec2 furthest_left = place + stretch.room_left * left_side;
      const Vec2 furthest_right = place - stretch.room_right * left_side;
      for (const Vec2& edge : {furthest_left, furthest_right}) {
        const double beyond = std::min(outer.centerline.project(edge).distance - 0.5 * outer.width,
                                       inner.centerline.project(edge).distance - 0.5 * inner.width);
        EXPECT_LT(beyond, 0.15) << "at " << along << " m of a road with "
                                << (network->left_hand ? "left" : "right") << "-hand traffic";
      }
    }
  }
}

TEST_F(Crossroads, RoundingKeepsTheEndsAndTheOrder) {
  const Path sharp = path_along(right(), {"WC", "CS"}, "WC_1");
  const Path round = path_along(right(), {"WC", "CS"}, "WC_1", 0, 5.0);
  expect_sound(round);
  EXPECT_NEAR((round.line.points().front() - sharp.line.points().front()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((round.line.points().back() - sharp.line.points().back()).norm(), 0.0, 1e-9);
  EXPECT_LE(round.line.length(), sharp.line.length() + 1e-9);
  EXPECT_LE(sharpest_turn(round), sharpest_turn(sharp) + 1e-9);
  // the stop line is carried along
  EXPECT_NEAR((round.line.point_at(round.links[0].stop_line) -
               sharp.line.point_at(sharp.links[0].stop_line))
                  .norm(),
              0.0, 1.0);
}

/// A path of one stretch along a line.
Path path_of(std::vector<Vec2> points) {
  Path path;
  path.line = Polyline(std::move(points));
  path.stretches.push_back({});
  path.stretches.back().to = path.line.length();
  return path;
}

TEST(RoundCorners, TurnsARightAngleAboutTheRadiusAskedFor) {
  Path path = path_of({{0, 0}, {40, 0}, {40, 40}});
  path.stops.push_back({40.0, 1.0});
  const double before = path.line.length();
  round_corners({2.5}, path);
  EXPECT_EQ(path.line.points().front(), Vec2(0, 0));
  EXPECT_EQ(path.line.points().back(), Vec2(40, 40));
  EXPECT_LT(path.line.length(), before);
  EXPECT_NEAR(path.stops.front().along, 0.5 * path.line.length(), 0.3);
  // tightest circle through neighbouring places, over the length of a wheelbase
  double radius = 1e9;
  for (double s = 30; s < 50; s += 0.5) {
    const double turn = std::abs(wrap_angle(heading_of(path.line.direction_at(s + 1.0)) -
                                            heading_of(path.line.direction_at(s - 1.0))));
    if (turn > 1e-6) radius = std::min(radius, 2.0 / turn);
  }
  EXPECT_GT(radius, 1.8);
  EXPECT_LT(radius, 5.0);
}

TEST(RoundCorners, TellByHowMuchTheyAreCut) {
  for (const double y : {40.0, -40.0}) {
    Path path = path_of({{0, 0}, {40, 0}, {40, y}});
    round_corners({2.5}, path);
    const double middle = 0.5 * path.line.length();
    const auto inner = [&](double from, double to) {
      const Cut cut = path.cut_between(from, to);
      EXPECT_NEAR(y > 0 ? cut.right : cut.left, 0.0, 1e-9) << "the outer side";
      return y > 0 ? cut.left : cut.right;
    };
    const double most = (path.line.point_at(middle) - Vec2(40, 0)).norm();
    EXPECT_NEAR(inner(middle - 5, middle + 5), most, 0.2);
    EXPECT_LT(inner(middle - 5, middle - 1.5), 0.5 * most);
    EXPECT_EQ(inner(0, middle - 10), 0.0);
    EXPECT_EQ(inner(200, 210), 0.0) << "past its end";
  }
}

// Lanes that overlap at a junction: the link between them leads back before it leads on.
//   (0,0) ----------------------> (30,0)
//              (22,0.5) <-------- '
//              '----------------------------> (60,0.5)
// What a map draws with a vertex here and there is driven smoothly, within a hand's breadth.
TEST(RoundCorners, SmoothsKinksWithoutLeavingTheLine) {
  Path path;
  path.line = Polyline({{0, 0}, {30, 0}, {60, 4}, {90, 4}});  // two kinks of 8 degrees
  const Polyline drawn = path.line;
  path.stretches.push_back({});
  path.stretches.back().to = path.line.length();
  round_corners({4.0}, path);
  double sharpest = 0, farthest = 0;
  for (double s = 1.0; s < path.line.length() - 1.0; s += 0.25) {
    const Vec2 place = path.line.point_at(s);
    farthest = std::max(farthest, drawn.project(place).distance);
    sharpest =
        std::max(sharpest, std::abs(wrap_angle(heading_of(path.line.direction_at(s + 1.0)) -
                                               heading_of(path.line.direction_at(s - 1.0)))));
  }
  EXPECT_LT(farthest, 0.2);
  EXPECT_GT(farthest, 0.05);
  EXPECT_LT(sharpest, 0.09) << "within 2 m; 0.13 rad as it is drawn";
}

// A junction whose lanes overlap by fifteen metres: cars drove to its far end, round on a sidewalk
// and back.
TEST(RoundCorners, DrawsLongFoldsStraight) {
  Path path = path_of({{0, 0}, {40, 0}, {25, 1}, {70, 1}});
  round_corners({4.0, 4.5, 1.8}, path);
  for (double s = 0.5; s < path.line.length(); s += 0.5)
    EXPECT_GT(path.line.direction_at(s).x(), 0.5) << "at " << s;
  EXPECT_LT(path.line.length(), 71.0);
}

TEST(RoundCorners, DrawsFoldsStraightAndCarriesPlacesOver) {
  Path path = path_of({{0, 0}, {30, 0}, {22, 0.5}, {60, 0.5}});
  path.links.push_back({kNoConnection, 30.0, 38.0, 30.0, 30.0});
  round_corners({4.0}, path);
  for (double s = 0.5; s < path.line.length(); s += 0.5)
    EXPECT_GT(path.line.direction_at(s).x(), 0.5) << "at " << s;
  EXPECT_LT(path.line.length(), 61.0);
  EXPECT_LT(path.links.front().stop_line, path.links.front().end);
  EXPECT_EQ(path.line.points().back(), Vec2(60, 0.5));
}

TEST(RoundCorners, WhoTurnsRoundStillTurnsRound) {
  Path path = path_of({{0, 0}, {30, 0}, {30, 3}, {0, 3}});
  round_corners({4.0}, path);
  EXPECT_EQ(path.line.points().back(), Vec2(0, 3));
  EXPECT_LT(path.line.direction_at(path.line.length() - 5).x(), -0.9);
  EXPECT_NEAR(path.line.point_at(0.5 * path.line.length()).x(), 28.0, 2.0);
}

// A way that turns back at an acute angle: bicycles rode to its tip, amid those who came the other
// way, and round on the spot.
TEST(RoundCorners, WhoIsNarrowTurnsBeforeTheTipOfAnAcuteAngle) {
  const auto farthest = [](const Cornering& cornering) {
    Path path = path_of({{0, 0}, {40, 0}, {10, 15}});
    round_corners(cornering, path);
    EXPECT_NEAR((path.line.points().back() - Vec2(10, 15)).norm(), 0.0, 1e-9);
    double most = 0;
    for (const Vec2& point : path.line.points()) most = std::max(most, point.x());
    return most;
  };
  // 4 m apart are the two branches 8.7 m from the tip
  EXPECT_LT(farthest({2.0, 1.8, 0.6}), 33.0);
  EXPECT_GT(farthest({2.0, 4.5, 1.8}), 35.0) << "where a car turns is the map's to say";
}

/// Tightest radius of a line between two places on it [m], over half a metre.
double tightest(const Polyline& line, double from, double to) {
  constexpr double kReach = 0.25;
  double radius = 1e9;
  for (double s = from; s < to; s += 0.1) {
    const double turn = std::abs(wrap_angle(heading_of(line.direction_at(s + kReach)) -
                                            heading_of(line.direction_at(s - kReach))));
    if (turn > 1e-6) radius = std::min(radius, 2.0 * kReach / turn);
  }
  return radius;
}

// A turnaround in a street: cars turned from the middle of their lane and left the road on its far
// side, since two lanes are less than two turning radii apart.
TEST(RoundCorners, WhoTurnsRoundSwingsOutBeforeThat) {
  for (const double side : {1.0, -1.0}) {
    Path path = path_of({{0, 0}, {40, 0}, {41, side * 1.6}, {40, side * 3.2}, {0, side * 3.2}});
    path.links.push_back({kNoConnection, 40.0, 44.0, 40.0, 40.0});
    round_corners({3.46, 4.5, 1.8}, path);
    EXPECT_GT(tightest(path.line, 15, path.line.length() - 15), 1.5) << "by vertices 0.5 m apart";
    double left = 0, right = 0, farthest = 0;
    for (const Vec2& point : path.line.points()) {
      left = std::max(left, side * point.y() - 1.6);
      right = std::max(right, 1.6 - side * point.y());
      farthest = std::max(farthest, point.x());
    }
    EXPECT_NEAR(left, 3.67, 0.2) << "as far to the one side as to the other";
    EXPECT_NEAR(right, 3.67, 0.2);
    EXPECT_NEAR(farthest, 41.0, 0.3) << "no further than the line is drawn";
    EXPECT_NEAR((path.line.points().back() - Vec2(0, side * 3.2)).norm(), 0.0, 1e-9);
  }
  Path wide = path_of({{0, 0}, {40, 0}, {40, 12}, {0, 12}});
  round_corners({3.46, 4.5, 1.8}, wide);
  for (const Vec2& point : wide.line.points()) EXPECT_GT(point.y(), -0.01);
}

// over 2 m a right angle seems as wide as a bicycle turns: it was left as sharp as it was drawn
TEST(RoundCorners, ABicycleTurnsWithItsRadius) {
  for (const double angle : {60.0, 90.0, 140.0}) {
    Path path = path_of({{0, 0}, {20, 0}, Vec2(20, 0) + 20 * direction_of(radians(angle))});
    const Polyline drawn = path.line;
    round_corners({1.15, 1.6, 0.65}, path);
    EXPECT_GT(tightest(path.line, 15, path.line.length() - 15), 0.7) << angle;
    for (double s = 0; s < path.line.length(); s += 0.25)
      EXPECT_LT(drawn.project(path.line.point_at(s)).distance, 1.2) << angle;
  }
}

// samples lie closer to each other on the piece that is drawn anew: its corners got hardly a window
TEST(RoundCorners, ThePieceAcrossAnAcuteAngleHasRoundCornersToo) {
  Path path = path_of({{0, 0}, {40, 0}, {10, 9}});
  path.links.push_back({kNoConnection, 20.0, 36.0, 20.0, 20.0});
  const Vec2 line_at = path.line.point_at(20.0);
  round_corners({1.15, 1.6, 0.65}, path);
  EXPECT_GT(tightest(path.line, 15, path.line.length() - 15), 0.7);
  EXPECT_NEAR((path.line.point_at(path.links.front().stop_line) - line_at).norm(), 0.0, 0.1);
}

TEST(SpeedProfile, ABicycleSlowsDownToTurn) {
  const auto slowest = [](double turning_radius) {
    Path path = path_of({{0, 0}, {30, 0}, {30, 30}});
    path.stretches.back().speed_limit = 6;
    PathRequest request;
    request.max_lateral_acceleration = 2.0;
    request.comfortable_deceleration = 2.0;
    request.cornering = {turning_radius, 1.6, 0.65};
    round_corners(request.cornering, path);
    compute_speed_profile(request, path);
    const std::vector<double> profile = path.speed_profile.unpacked();
    return *std::min_element(profile.begin(), profile.end());
  };
  EXPECT_LT(slowest(1.15), 2.3) << "1.5 m/s in a circle of 1.15 m";
  EXPECT_GT(slowest(4.4), 2.8);
}

TEST(SpeedProfile, BrakesSteadilyBetweenItsPlaces) {
  Path path;
  path.line = Polyline({{0, 0}, {4, 0}});
  path.speed_profile = PackedValues(std::vector{6.0, 5.0, 4.0});
  // v^2 is linear along the way where the deceleration is steady
  EXPECT_NEAR(path.profile_at(0.5 * Path::kProfileStep), std::sqrt(0.5 * (36.0 + 25.0)), 1e-12);
  EXPECT_NEAR(path.profile_at(Path::kProfileStep), 5.0, 1e-12);
}

// A path whose rounded corner passes the end of its lane before its own stop line does.
TEST_F(Crossroads, StopLinesLieWhereThePathPassesTheEndOfItsLane) {
  const std::vector<EdgeId> route = route_of(right(), {"WC", "CS"});
  PathRequest request = request_of(route);
  request.cornering.turning_radius = 6.0;
  std::string why;
  const auto path = build_driving_path(right(), request, why);
  ASSERT_TRUE(path) << why;
  const PathLink& link = path->links.front();
  const Polyline& lane = right().lane(right().connection(link.connection).from).centerline;
  const Vec2 forward = lane.direction_at(lane.length());
  const Vec2 place = path->line.point_at(link.stop_line);
  EXPECT_LE((place - lane.points().back()).dot(forward), 0.05 + 1e-9);
  EXPECT_GT((place - lane.points().back()).dot(forward), -1.5);
}

TEST(RoundCorners, LeavesShortAndStraightLinesAlone) {
  Path straight;
  straight.line = Polyline({{0, 0}, {30, 0}});
  round_corners({5.0}, straight);
  EXPECT_NEAR(straight.line.length(), 30.0, 1e-9);
  Path tiny;
  tiny.line = Polyline({{0, 0}, {1, 0}, {1, 0.5}});
  round_corners({5.0}, tiny);
  EXPECT_EQ(tiny.line.points().size(), 3u);
}

/// A bend of 30 degrees and 14 m of radius, whose right kerb is `kerb` from its line [m].
Path bend_to(bool left, double kerb) {
  constexpr double kRadius = 14;
  const double side = left ? 1.0 : -1.0;
  std::vector<Vec2> points = {{-40, 0}};
  for (int degrees = 0; degrees <= 30; degrees += 3)
    points.push_back({kRadius * std::sin(radians(degrees)),
                      side * kRadius * (1.0 - std::cos(radians(degrees)))});
  points.push_back(points.back() +
                   40.0 * Vec2(std::cos(radians(30)), side * std::sin(radians(30))));
  Path path;
  path.line = Polyline(points);
  PathStretch stretch;
  stretch.to = path.line.length();
  stretch.kerb = kerb;
  path.stretches.push_back(stretch);
  return path;
}

/// How far a rounded line passes the middle of the bend, inside positive [m].
double cut_of(Path path, const Cornering& cornering) {
  const Vec2 apex = path.line.point_at(0.5 * path.line.length());
  const Vec2 across = left_of(path.line.direction_at(0.5 * path.line.length()));
  const bool left = path.line.points().back().y() > 0.0;
  round_corners(cornering, path);
  const PolylinePosition place = path.line.project(apex);
  return (left ? 1.0 : -1.0) * (path.line.point_at(place.along) - apex).dot(across);
}

TEST(RoundCorners, LongBodiesCutABendTowardsTheKerbWhereItIsFarEnough) {
  const Cornering car{4.0, 4.5, 1.8, false}, bus{6.6, 12.0, 2.5, false};
  EXPECT_LT(std::abs(cut_of(bend_to(false, 3.0), car)), 0.2);
  EXPECT_GT(cut_of(bend_to(false, 3.0), bus), 0.45);
  EXPECT_LT(cut_of(bend_to(false, 3.0), bus), 1.2);
  // no further than its sides stay off the kerb
  EXPECT_LT(cut_of(bend_to(false, 1.7), bus), 0.4);
  EXPECT_LT(cut_of(bend_to(false, 1.4), bus), 0.2);
  // nor towards the traffic that comes
  EXPECT_LT(std::abs(cut_of(bend_to(true, 3.0), bus)), 0.2);
  const Cornering keeps_left{6.6, 12.0, 2.5, true};
  EXPECT_GT(cut_of(bend_to(true, 3.0), keeps_left), 0.45);
  EXPECT_LT(std::abs(cut_of(bend_to(false, 3.0), keeps_left)), 0.2);
}

TEST(AppendSpan, RunsBothWaysAndKeepsTheVertices) {
  const Polyline line({{0, 0}, {10, 0}, {10, 10}});
  std::vector<Vec2> forward, backward;
  append_span(line, 5, 15, forward);
  append_span(line, 15, 5, backward);
  EXPECT_EQ(forward, (std::vector<Vec2>{{5, 0}, {10, 0}, {10, 5}}));
  std::reverse(backward.begin(), backward.end());
  EXPECT_EQ(forward, backward);
}

TEST_F(Crossroads, BrakesBeforeTheBendAtEase) {
  const std::vector<EdgeId> route = route_of(right(), {"WC", "CS"});
  PathRequest request = request_of(route);
  request.cornering.turning_radius = 4.0;
  std::string why;
  const auto path = build_driving_path(right(), request, why);
  ASSERT_TRUE(path) << why;
  const double at_bend = path->profile_at(0.5 * (path->links[0].stop_line + path->links[0].end));
  EXPECT_LT(at_bend, 7.5);
  EXPECT_GT(at_bend, 2.5);
  EXPECT_NEAR(path->profile_at(20), 13, 0.1);
  for (std::size_t i = 0; i + 1 < path->speed_profile.size(); ++i) {
    const double v = path->speed_profile[i], next = path->speed_profile[i + 1];
    EXPECT_LE((v * v - next * next) / (2 * Path::kProfileStep),
              request.comfortable_deceleration + 1e-9);
  }
}

/// A quarter of a circle between straights of 150 and 180 m, allowed at 25 m/s.
Path along_arc(double radius) {
  std::vector<Vec2> points = {{-150, 0}};
  for (int degrees = 0; degrees <= 90; ++degrees)
    points.push_back(
        {radius * std::sin(radians(degrees)), radius - radius * std::cos(radians(degrees))});
  points.push_back({radius, radius + 180});
  Path path = path_of(points);
  path.stretches.back().speed_limit = 25;
  return path;
}

// The brakes go down and come up over some time before and in a bend: steps would be jerks.
TEST(SpeedProfile, BrakesByRamps) {
  constexpr double kRadius = 20;
  Path path = along_arc(kRadius);
  PathRequest request;
  request.max_lateral_acceleration = 2.0;
  request.comfortable_deceleration = 2.5;
  compute_speed_profile(request, path);
  const auto braking = [&](std::size_t i) {
    const double v = path.speed_profile[i], next = path.speed_profile[i + 1];
    return (v * v - next * next) / (2 * Path::kProfileStep);
  };
  double hardest = 0.0, jerk = 0.0;
  const auto in_bend = static_cast<std::size_t>((150 + 0.5 * kRadius) / Path::kProfileStep);
  for (std::size_t i = 0; i + 1 < in_bend; ++i) {
    const double time = Path::kProfileStep / path.speed_profile[i + 1];
    jerk = std::max(jerk, std::abs(braking(i + 1) - braking(i)) / time);
    hardest = std::max(hardest, braking(i));
  }
  EXPECT_NEAR(hardest, 2.5, 0.01);
  EXPECT_LT(jerk, 2.5 / 0.6);
}

TEST(SpeedProfile, TakesAnArcAtTheComfortLimit) {
  constexpr double kRadius = 20;
  Path path = along_arc(kRadius);
  PathRequest request;
  request.max_lateral_acceleration = 2.0;
  compute_speed_profile(request, path);
  const double middle = 150 + 0.5 * kRadius * 0.5 * kPi;
  EXPECT_NEAR(path.profile_at(middle), std::sqrt(2.0 * kRadius), 0.1);
  EXPECT_NEAR(path.profile_at(0), 25, 1e-9);
  // speed is taken up again behind it: the profile only brakes ahead
  EXPECT_NEAR(path.profile_at(path.line.length()), 25, 1e-9);
}

// who was put on the road right before a kink came off it onto the sidewalk
TEST(SpeedProfile, KnowsOfABendWhereItBegins) {
  const Vec2 turned = direction_of(0.6);
  Path path = path_of({{0, 0}, {0.4, 0}, Vec2(0.4, 0) + 60.0 * turned});
  path.stretches.back().speed_limit = 14;
  compute_speed_profile({}, path);
  EXPECT_LT(path.profile_at(0), 7.0);
  EXPECT_GT(path.profile_at(20), 13.0);
}

/// Speed that the bends of a line leave, halfway along it, to who turns within a radius [m/s].
double speed_halfway(std::vector<Vec2> points, double turning_radius = 0.0) {
  Path path = path_of(std::move(points));
  path.stretches.back().speed_limit = 25;
  PathRequest request;
  request.cornering.turning_radius = turning_radius;
  request.max_lateral_acceleration = 2.0;
  request.comfortable_deceleration = 100.0;
  compute_speed_profile(request, path);
  return path.profile_at(0.5 * path.line.length());
}

// a vertex of a map is no corner: at 0.2 rad over the 13 m of 0.6 s to each side, not over 6 m
TEST(SpeedProfile, SpreadsAKinkOverTheTimeThatSteeringTakes) {
  const Vec2 turned = direction_of(0.2);
  const double at_kink = speed_halfway({{-100, 0}, {0, 0}, 100 * turned});
  EXPECT_NEAR(at_kink, std::sqrt(2.0 * 18.0 / 0.2), 1.5);
  EXPECT_GT(at_kink, std::sqrt(2.0 * 6.0 / 0.2) + 2.0);
}

// motorcycles rode the kinks of Monaco's roads a tenth more slowly than cars
TEST(SpeedProfile, MotorcyclesTakeAKinkAsCarsDoAndBicyclesMoreSlowly) {
  const std::vector<Vec2> kink = {{-100, 0}, {0, 0}, 100 * direction_of(0.2)};
  EXPECT_DOUBLE_EQ(speed_halfway(kink, 1.8), speed_halfway(kink, 5.5));
  EXPECT_LT(speed_halfway(kink, 1.2), 0.8 * speed_halfway(kink, 5.5));
}

TEST(SpeedProfile, BendsOneAfterTheOtherDontCancelEachOtherOut) {
  constexpr double kRadius = 10;
  std::vector<Vec2> points;
  for (int degrees = 60; degrees >= 0; degrees -= 2)
    points.push_back(
        {-kRadius * std::sin(radians(degrees)), -kRadius + kRadius * std::cos(radians(degrees))});
  for (int degrees = 2; degrees <= 60; degrees += 2)
    points.push_back(
        {kRadius * std::sin(radians(degrees)), kRadius - kRadius * std::cos(radians(degrees))});
  EXPECT_LT(speed_halfway(points), std::sqrt(2.0 * kRadius) + 0.7);
}

TEST_F(Crossroads, TheProfileKnowsLimitsFactorsAndTopSpeed) {
  const std::vector<EdgeId> route = route_of(right(), {"WC", "CE"});
  PathRequest request = request_of(route);
  std::string why;
  request.speed_factor = 1.2;
  EXPECT_NEAR(build_driving_path(right(), request, why)->profile_at(50), 1.2 * 13, 0.05);
  request.max_speed = 6;
  EXPECT_NEAR(build_driving_path(right(), request, why)->profile_at(50), 6, 1e-9);
}

TEST(DrivingPath, ALaneChangeInABendNeverDoublesBack) {
  // a quarter circle of radius 40: its outer lane is some 5 m longer than the inner one
  std::string shape;
  for (int degrees = 0; degrees <= 90; degrees += 5) {
    char point[64];
    std::snprintf(point, sizeof point, "%.3f,%.3f ", 40 * std::sin(radians(degrees)),
                  40 - 40 * std::cos(radians(degrees)));
    shape += point;
  }
  PlainNet plain;
  plain.nodes = R"(<node id="A" x="0" y="0"/><node id="B" x="40" y="40"/>
                   <node id="L" x="40" y="140"/><node id="R" x="140" y="40"/>)";
  plain.edges = R"(<edge id="bend" from="A" to="B" numLanes="2" speed="13.9" shape=")" + shape +
                R"("/><edge id="on" from="B" to="L" numLanes="1" speed="13.9"/>)";
  for (const char* option : {"", "--lefthand"}) {
    for (const int target_from : {0, 1}) {
      PlainNet net = plain;
      net.connections = "<connection from=\"bend\" to=\"on\" fromLane=\"" +
                        std::to_string(target_from) + "\" toLane=\"0\"/>";
      if (*option) net.options = {option};
      const RoadNetwork network = read_plain_net(net);
      const std::string start = "bend_" + std::to_string(1 - target_from);
      const Path path = path_along(network, {"bend", "on"}, start);
      expect_sound(path);
      EXPECT_LT(sharpest_turn(path), radians(60)) << start << " " << option;
      // and reaches the very end of the lane that it changed to
      const Lane& lane =
          network.lane(network.lane_by_name.at("bend_" + std::to_string(target_from)));
      EXPECT_NEAR(
          (path.line.point_at(path.links.front().stop_line) - lane.centerline.points().back())
              .norm(),
          0.0, 1e-6)
          << start << " " << option;
    }
  }
}

// a road that widens: from its single lane both lead on, the inner one straight
TEST(DrivingPath, TakesTheLaneThatGoesStraightOnWhereBothLeadOn) {
  PlainNet plain;
  plain.nodes = R"(<node id="A" x="0" y="0"/><node id="B" x="100" y="0"/>
                   <node id="C" x="300" y="0"/>)";
  plain.edges = R"(<edge id="in" from="A" to="B" numLanes="1" speed="13.9"/>
                   <edge id="on" from="B" to="C" numLanes="2" speed="13.9"/>)";
  plain.connections = R"(<connection from="in" to="on" fromLane="0" toLane="0"/>
                         <connection from="in" to="on" fromLane="0" toLane="1"/>)";
  const RoadNetwork network = read_plain_net(plain);
  const Path path = path_along(network, {"in", "on"});
  EXPECT_EQ(lanes_of(network, path), (std::vector<std::string>{"in_0", "on_1"}));
  EXPECT_GT(path.profile_at(100.0), 13.0);
}

TEST(DrivingPath, ManyChangesOnAShortEdgeStillEndOnTheRightLane) {
  PlainNet plain;
  plain.nodes = R"(<node id="A" x="0" y="0"/><node id="B" x="40" y="0"/>
                   <node id="D" x="140" y="0"/>)";
  plain.edges = R"(<edge id="wide" from="A" to="B" numLanes="4" speed="13.9"/>
                   <edge id="on" from="B" to="D" numLanes="1" speed="13.9"/>)";
  plain.connections = R"(<connection from="wide" to="on" fromLane="3" toLane="0"/>)";
  const RoadNetwork network = read_plain_net(plain);
  const Path path = path_along(network, {"wide", "on"}, "wide_0");
  expect_sound(path);
  EXPECT_EQ(lanes_of(network, path),
            (std::vector<std::string>{"wide_0", "wide_1", "wide_2", "wide_3", "on_0"}));
}

// it cut across the lanes in front of faster ones
TEST(DrivingPath, WhoStartsAtTheEndOfAnEdgeChangesLanesOnTheNext) {
  PlainNet plain;
  plain.nodes = R"(<node id="A" x="0" y="0"/><node id="B" x="200" y="0"/>
                   <node id="C" x="260" y="0"/><node id="D" x="360" y="0"/>)";
  plain.edges = R"(<edge id="first" from="A" to="B" numLanes="2" speed="13.9"/>
                   <edge id="next" from="B" to="C" numLanes="2" speed="13.9"/>
                   <edge id="on" from="C" to="D" numLanes="1" speed="13.9"/>)";
  plain.connections = R"(<connection from="first" to="next" fromLane="0" toLane="0"/>
                         <connection from="first" to="next" fromLane="1" toLane="1"/>
                         <connection from="next" to="on" fromLane="1" toLane="0"/>)";
  const RoadNetwork network = read_plain_net(plain);
  const std::vector<std::string> route = {"first", "next", "on"};
  EXPECT_EQ(lanes_of(network, path_along(network, route, "first_0", 20)),
            (std::vector<std::string>{"first_0", "first_1", "next_1", "on_0"}));
  EXPECT_EQ(lanes_of(network, path_along(network, route, "first_0", 185)),
            (std::vector<std::string>{"first_0", "next_0", "next_1", "on_0"}));
}

TEST(DrivingPath, FollowsInternalLanesOfSmallNet) {
  const RoadNetwork network = testing::small_net();
  const Path path = path_along(network, {"in", "out"});
  expect_sound(path);
  ASSERT_EQ(path.links.size(), 1u);
  EXPECT_NEAR(path.links[0].stop_line, 95, 1e-9);
  EXPECT_NEAR(path.links[0].end, 105, 1e-9);
  EXPECT_EQ(network.lane(path.stretch_at(100).lane).name, ":C_0_0");
  EXPECT_NEAR(path.line.length(), 200, 1e-9);
}

// the way leads into the lane of a stop before it, and out of it again for the turn behind it
TEST(RouteStops, ArePassedInTheirLane) {
  const RoadNetwork network = read_plain_net(crossroads("priority"));
  const std::vector<EdgeId> route = route_of(network, {"WC", "CN"});
  PathRequest request = request_of(route);
  request.start_lane = network.lane_by_name.at("WC_1");
  request.stops = {{0, 0, 90.0, 12.0, 3}};
  std::string why;
  const std::optional<Path> path = build_driving_path(network, request, why);
  ASSERT_TRUE(path) << why;
  expect_sound(*path);
  EXPECT_EQ(lanes_of(network, *path), (std::vector<std::string>{"WC_1", "WC_0", "WC_1", "CN_0"}));
  ASSERT_EQ(path->stops.size(), 1u);
  const PathStop& stop = path->stops.front();
  EXPECT_EQ(network.lane(path->stretch_at(stop.along).lane).name, "WC_0");
  EXPECT_NEAR((path->line.point_at(stop.along) -
               network.lane(network.lane_by_name.at("WC_0")).centerline.point_at(90.0))
                  .norm(),
              0.0, 0.3);
  EXPECT_EQ(stop.plan, 3);
  EXPECT_EQ(stop.room, 12.0);
  EXPECT_TRUE(std::isinf(stop.duration));
}

TEST(RouteStops, BehindTheBeginningAreNone) {
  const RoadNetwork network = read_plain_net(crossroads("priority"));
  const std::vector<EdgeId> route = route_of(network, {"WC", "CE"});
  PathRequest request = request_of(route);
  request.start_along = 120.0;
  request.stops = {{0, -1, 90.0, 0.0, 0}, {1, -1, 50.0, 0.0, 1}};
  std::string why;
  const std::optional<Path> path = build_driving_path(network, request, why);
  ASSERT_TRUE(path) << why;
  ASSERT_EQ(path->stops.size(), 1u);
  EXPECT_EQ(path->stops.front().plan, 1);
}

TEST(SpeedLimits, ThatHoldNowTakeThePlaceOfTheNetworks) {
  const RoadNetwork network = read_plain_net(crossroads("priority"));
  const Path path = path_along(network, {"WC", "CE"});
  std::vector<double> limits;
  for (const Lane& lane : network.lanes) limits.push_back(lane.speed_limit);
  limits[index_of(path.stretches.front().lane)] = 5.0;
  const Path slower = with_speed_limits(path, limits);
  EXPECT_EQ(slower.line.length(), path.line.length());
  EXPECT_NEAR(slower.profile_at(50.0), 5.0, 0.1);
  EXPECT_NEAR(slower.profile_at(slower.arrival - 50.0), path.profile_at(path.arrival - 50.0), 0.1);
}

}  // namespace
}  // namespace sumogamma
