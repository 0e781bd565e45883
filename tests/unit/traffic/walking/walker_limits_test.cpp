#include "traffic/walking/walker_limits.h"

#include <gtest/gtest.h>

#include "model/context.h"
#include "road/path_pieces.h"
#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;

class WalkersAtRed : public ::testing::Test {
 protected:
  WalkersAtRed() {
    for (std::string& states : here_.road.signal_states) states = std::string(100, 'r');
  }
  void put(std::size_t walker, double front) {
    here_.move(walker, front - 0.2);
    here_.update();
  }
  /// Does somebody aim back at the kerb whose front is so far past it [m]?
  bool steps_back(std::size_t walker, double front) {
    const double kerb = here_.path(walker).links.at(0).stop_line;
    put(walker, kerb + front);
    const Vec2 way = here_.context(walker).sub_goal - here_.scene.position[walker];
    return way.dot(here_.path(walker).line.direction_at(kerb)) < 0.0;
  }
  RoadScene here_{
      read_plain_net(crossroads("traffic_light", {"--sidewalks.guess", "--crossings.guess"}))};
};

TEST_F(WalkersAtRed, WhoIsAtTheKerbHaltsThoughNotAtEaseAndWhoIsOnTheCrossingGoesOn) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 1.4, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  auto is_held = [&](double front) {
    put(walker, kerb + front);
    return here_.context(walker).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(is_held(-1.0));
  EXPECT_TRUE(is_held(-0.1));
  EXPECT_TRUE(is_held(0.15));  // a foot on it
  EXPECT_TRUE(is_held(0.45));  // at full pace
  EXPECT_FALSE(is_held(1.0));
}

// before a bus that stood on the crossing somebody found its way round it at red
TEST_F(WalkersAtRed, WhoHasHardlySteppedOnAndCrawlsWaits) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.3, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  put(walker, kerb + 0.45);
  EXPECT_EQ(here_.context(walker).reason, LimitReason::Signal);
  here_.scene.context[walker] = {};
  put(walker, kerb + 0.75);
  EXPECT_NE(here_.context(walker).reason, LimitReason::Signal);
}

// in a crowd at the kerb: who was pressed onto the road took itself for somebody who crosses
TEST_F(WalkersAtRed, WhoWaitsForTheLightAndIsPressedOnStepsBack) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  EXPECT_FALSE(steps_back(walker, 2.0)) << "it crosses";
  steps_back(walker, -0.1);
  ASSERT_EQ(here_.context(walker).reason, LimitReason::Signal);
  EXPECT_TRUE(steps_back(walker, 2.0)) << "it waited";
}

// it turned round half a metre after the light had changed, and others who came back behind it
// pressed it on over the crossing
TEST_F(WalkersAtRed, WhoStepsBackGoesNoFurtherOn) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  const Vec2 across = here_.path(walker).line.direction_at(kerb);
  steps_back(walker, -0.1);
  ASSERT_TRUE(steps_back(walker, 1.5));
  const auto admits = [&](const Vec2& velocity) {
    ConstraintSet set;
    append_contextual_constraints(here_.model, here_.scene, walker, set);
    return std::all_of(set.planes.begin(), set.planes.end(),
                       [&](const HalfPlane& plane) { return slack(plane, velocity) > -1e-9; });
  };
  EXPECT_FALSE(admits(0.1 * across));
  EXPECT_TRUE(admits(-0.3 * across));
  EXPECT_TRUE(admits(Vec2::Zero()));
}

// at green a queue stood over the crossing: it shuffled about there until the light was red, and
// then on to and fro
TEST_F(WalkersAtRed, WhoSetOutAndGotNoFurtherStepsBack) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  here_.traffic.waiting_time[walker] = 5.0;
  EXPECT_TRUE(steps_back(walker, 2.0));
  EXPECT_EQ(here_.context(walker).reason, LimitReason::Signal);
  here_.scene.context[walker] = {};
  EXPECT_FALSE(steps_back(walker, 4.0)) << "amid the road it goes on";
  EXPECT_NE(here_.context(walker).reason, LimitReason::Signal);
}

// in the crowd of a corner somebody was pressed onto the crossing to which its way leads in the end
TEST_F(WalkersAtRed, WhoseWayToItsCrossingIsLongIsKeptOffIt) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  Path path = here_.path(walker);
  const double kerb = path.links.at(0).stop_line, turn = kerb - 0.5, round = 6.0;
  const Vec2 across = path.line.direction_at(kerb);
  // before the kerb it goes three metres aside and comes back
  std::vector<Vec2> points;
  append_span(path.line, 0.0, turn, points);
  points.push_back(path.line.point_at(turn) + 0.5 * round * left_of(across));
  append_span(path.line, turn, path.line.length(), points);
  path.line = Polyline(points);
  for (PathStretch& stretch : path.stretches) {
    if (stretch.from > turn) stretch.from += round;
    if (stretch.to > turn) stretch.to += round;
  }
  for (PathLink& link : path.links)
    for (double* place : {&link.stop_line, &link.halt, &link.inside, &link.end}) *place += round;
  here_.road.paths[static_cast<std::size_t>(here_.scene.path[walker])] =
      std::make_shared<const Path>(path);
  put(walker, turn - 0.1);
  ASSERT_NE(here_.context(walker).reason, LimitReason::Signal) << "not yet";
  EXPECT_GT(here_.context(walker).to_red[0].dot(across), 0.0);
  // on its rim when the light changed: no further on
  here_.scene.position[walker] = path.line.point_at(turn) + 0.8 * across + 0.9 * left_of(across);
  here_.update();
  EXPECT_GT(here_.context(walker).to_red[0].dot(across), 0.0);
}

// pressed off the crossing again, it shuffled onto it round somebody who stood behind it
TEST_F(WalkersAtRed, WhoWaitsBesideItsCrossingIsKeptOffIt) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.1, 195, 5);
  const double kerb = here_.path(walker).links.at(0).stop_line;
  const Vec2 across = here_.path(walker).line.direction_at(kerb);
  auto admits = [&](const Vec2& velocity) {
    ConstraintSet set;
    append_contextual_constraints(here_.model, here_.scene, walker, set);
    return std::all_of(set.planes.begin(), set.planes.end(),
                       [&](const HalfPlane& plane) { return slack(plane, velocity) > -1e-9; });
  };
  // beside it on its first metre, and before it
  const Vec2 aside = left_of(across);
  here_.move(walker, kerb + 0.3);
  here_.scene.position[walker] += 2.5 * aside;
  here_.update();
  ASSERT_EQ(here_.context(walker).reason, LimitReason::Signal);
  EXPECT_NEAR(here_.context(walker).to_red[0].dot(-aside), 0.5 - 0.2, 0.1);
  EXPECT_FALSE(admits(-0.9 * aside));
  EXPECT_TRUE(admits(-0.3 * aside));
  // at its edge: at 2 cm/s one was on it after 16 s
  here_.move(walker, kerb + 0.3);
  here_.scene.position[walker] += (2.5 - here_.context(walker).to_red[0].norm() + 0.05) * aside;
  here_.update();
  here_.scene.position[walker] += here_.context(walker).to_red[0];
  here_.update();
  EXPECT_FALSE(admits(-0.01 * aside));
  EXPECT_TRUE(admits(Vec2::Zero()));
  put(walker, kerb - 0.2);
  EXPECT_GT(here_.context(walker).to_red[0].dot(across), 0.0);
  for (std::string& states : here_.road.signal_states) states = std::string(100, 'G');
  put(walker, kerb - 0.2);
  EXPECT_TRUE(here_.context(walker).to_red[0].isZero());
}

// a lorry stood a whole green before somebody who waited on an island of 0.6 m with a foot on its
// side
// it had crossed, met a crowd at the other kerb, and went round that over the crossing again
TEST_F(WalkersAtRed, WhoHasCrossedIsKeptOffTheCrossingBehindIt) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.3, 195, 5);
  const Path& path = here_.path(walker);
  const auto crossing =
      std::find_if(path.stretches.begin(), path.stretches.end(), [&](const PathStretch& stretch) {
        return here_.model.road.lane(stretch.lane).kind == LaneKind::Crossing;
      });
  ASSERT_NE(crossing, path.stretches.end());
  const Lane& lane = here_.model.road.lane(crossing->lane);
  const Vec2 across = path.line.direction_at(0.5 * (crossing->from + crossing->to));
  const double half = 0.5 * lane.centerline.length();
  const Vec2 far_end = lane.centerline.point_at(half) + half * across;
  here_.move(walker, crossing->to + 0.6);
  here_.scene.position[walker] = far_end + 0.6 * across;
  here_.update();
  EXPECT_LT((here_.context(walker).to_red[0] + 0.4 * across).norm(), 0.15);
  const auto is_kept_off_at = [&](double before) {
    here_.move(walker, crossing->to - before);
    here_.scene.position[walker] = far_end - before * across;
    here_.update();
    const auto& ways = here_.context(walker).to_red;
    return std::any_of(ways.begin(), ways.end(),
                       [&](const Vec2& way) { return way.dot(across) < 0.0; });
  };
  EXPECT_FALSE(is_kept_off_at(1.5)) << "it is on it";
  EXPECT_TRUE(is_kept_off_at(0.6)) << "about to leave it: one went back onto it round a bicycle";
}

TEST_F(WalkersAtRed, OnANarrowIslandPeopleStandInItsMiddle) {
  const std::size_t walker = here_.add("pedestrian", {"WC", "CW"}, 0, 0.3, 195, 5);
  Path path = here_.path(walker);
  const PathLink whole = path.links.at(0);
  PathLink first = whole, second = whole;
  const double island = 0.5 * (whole.stop_line + whole.end);
  first.end = island;
  second.stop_line = second.halt = island + 0.6;
  path.links = {first, second};
  here_.road.paths[static_cast<std::size_t>(here_.scene.path[walker])] =
      std::make_shared<const Path>(path);
  // on its way to it, there, and a little too far
  auto is_held = [&](double middle) {
    put(walker, island + middle + 0.2);
    EXPECT_EQ(here_.context(walker).reason, LimitReason::Signal);
    return here_.context(walker).allowed_speed < 0.1;
  };
  EXPECT_FALSE(is_held(-0.2));
  EXPECT_TRUE(is_held(0.3));
  EXPECT_TRUE(is_held(0.4));
}

// who made way for others at the corner got onto a crossing that was red, and not its own
TEST(SignalledCorner, NobodyStepsAsideOntoACrossingThatIsRed) {
  const RoadNetwork net =
      read_plain_net(crossroads("traffic_light", {"--sidewalks.guess", "--crossings.guess"}));
  RoadScene here{net};
  // round the south-western corner, between two crossings
  const std::size_t walker = here.add("pedestrian", {"WC", "CS"}, 0, 1.3, 195, 5);
  ASSERT_TRUE(here.path(walker).links.empty());
  auto way_at = [&](double along, char signal) {
    here.road.signal_states.assign(net.signals.size(), std::string(32, signal));
    here.move(walker, along);
    here.update();
    return here.context(walker).to_red[0];
  };
  int bounded = 0;
  for (const PathStretch& stretch : here.path(walker).stretches) {
    if (net.lane(stretch.lane).kind != LaneKind::WalkingArea) continue;
    const double middle = 0.5 * (stretch.from + stretch.to);
    EXPECT_TRUE(way_at(middle, 'G').isZero());
    const Vec2 way = way_at(middle, 'r');
    if (way.isZero()) continue;
    ++bounded;
    const Vec2 edge = here.scene.position[walker] + way;
    double least = std::numeric_limits<double>::infinity();
    for (const Lane& lane : net.lanes) {
      if (lane.kind != LaneKind::Crossing) continue;
      const auto& points = lane.centerline.points();
      const double length = (points.back() - points.front()).norm();
      const Vec2 at = to_body(edge - points.front(), (points.back() - points.front()) / length);
      const Vec2 off(std::max({0.0, -at.x(), at.x() - length}),
                     std::max(0.0, std::abs(at.y()) - 0.5 * lane.width));
      least = std::min(least, off.norm());
    }
    const AgentType& type = type_of(here.model.types, here.scene.type[walker]);
    EXPECT_LE(least, 0.5 * std::hypot(type.length, type.width) + 1e-6)
        << "a crossing lies half a body further";
  }
  EXPECT_GT(bounded, 0);
}

}  // namespace
}  // namespace sumogamma
