#include "planning/hybrid_astar.h"

#include <gtest/gtest.h>

#include <vector>

#include "planning/dubins.h"
#include "scene/agent_type.h"

namespace sumogamma {
namespace {

WheeledShape car() {
  const AgentTypeTable types = default_agent_types();
  return wheeled_shape(type_of(types, find_agent_type(types, "car")));
}

OrientedBox box(double x, double y, double length, double width) {
  return {Vec2(x, y), Vec2(1, 0), Vec2(length / 2, width / 2)};
}

/// A straight road eastwards along y = 0, `left` and `right` wide beside its middle.
Path straight_road(double length, double left, double right) {
  Path path;
  path.line = Polyline({Vec2(-20, 0), Vec2(length, 0)});
  PathStretch stretch;
  stretch.from = 0;
  stretch.to = length + 20;
  stretch.room_left = left;
  stretch.room_right = right;
  path.stretches = {stretch};
  return path;
}

TEST(Dubins, GoesStraightAndTurnsBackOnHalfACircle) {
  EXPECT_NEAR(dubins_way({Vec2(0, 0), 0}, {Vec2(10, 0), 0}, 5).length(), 10, 1e-9);
  EXPECT_NEAR(dubins_way({Vec2(0, 0), 0}, {Vec2(0, 10), M_PI}, 5).length(), 5 * M_PI, 1e-9);
  // nearer than a circle's width: left, right by more than half, left
  const double back = dubins_way({Vec2(0, 0), 0}, {Vec2(0, 1), M_PI}, 5).length();
  EXPECT_GT(back, 5 * M_PI);
  EXPECT_LT(back, 5 * 3 * M_PI);
}

TEST(HybridAStar, GoesStraightWhereNothingIsInTheWay) {
  const Path road = straight_road(60, 1.75, 1.75);
  const FoundWay found = find_way(car(), {Vec2(0, 0), 0}, {Vec2(30, 0), 0}, {.lanes = &road});
  ASSERT_EQ(found.result, WaySearch::Found);
  EXPECT_NEAR(found.length, 30, 1e-6);
  for (const AxlePose& pose : found.poses) EXPECT_NEAR(pose.position.y(), 0, 1e-9);
  for (std::size_t i = 1; i < found.poses.size(); ++i)
    EXPECT_LE((found.poses[i].position - found.poses[i - 1].position).norm(), 0.25 + 1e-9);
}

TEST(HybridAStar, TurnsBackAtItsRadius) {
  const WheeledShape shape = car();
  const double radius = shape.turning_radius();
  const FoundWay found = find_way(shape, {Vec2(0, 0), 0}, {Vec2(0, 2 * radius), M_PI}, {});
  ASSERT_EQ(found.result, WaySearch::Found);
  EXPECT_NEAR(found.length, M_PI * radius, 0.05);
}

TEST(HybridAStar, GoesRoundAParkedCar) {
  const Path road = straight_road(60, 5.25, 1.75);
  const std::vector<OrientedBox> parked = {box(18, -0.3, 4.5, 1.8)};
  const DrivableSpace space{.lanes = &road, .bodies = parked};
  const FoundWay found = find_way(car(), {Vec2(0, 0), 0}, {Vec2(40, 0), 0}, space);
  ASSERT_EQ(found.result, WaySearch::Found);
  double farthest = 0;
  for (const AxlePose& pose : found.poses) {
    farthest = std::max(farthest, pose.position.y());
    EXPECT_GT(separation(body_at(car(), pose), parked[0]), 0);
  }
  EXPECT_GT(farthest, 1.0);
  EXPECT_LT(found.length, 43);
}

FoundWay through_gap(double room) {
  const WheeledShape shape = car();
  const double edge = (shape.width + 2 * 0.3 + room) / 2;
  const std::vector<OrientedBox> sides = {box(15, edge + 2, 3, 4), box(15, -edge - 2, 3, 4)};
  const Path road = straight_road(60, edge + 2, edge + 2);
  return find_way(shape, {Vec2(0, 0), 0}, {Vec2(30, 0), 0}, {.lanes = &road, .bodies = sides});
}

TEST(HybridAStar, TakesAGapThatIsWideEnough) {
  EXPECT_EQ(through_gap(0.1).result, WaySearch::Found);
  EXPECT_NE(through_gap(-0.1).result, WaySearch::Found);
}

TEST(HybridAStar, SaysThatThereIsNoWay) {
  const Path road = straight_road(60, 1.75, 1.75);
  const std::vector<OrientedBox> across = {box(20, 0, 2, 3.4)};
  const DrivableSpace space{.lanes = &road, .bodies = across};
  const FoundWay found = find_way(car(), {Vec2(0, 0.2), 0}, {Vec2(40, 0), 0}, space);
  EXPECT_EQ(found.result, WaySearch::Unreachable);
  EXPECT_TRUE(found.poses.empty());
}

TEST(HybridAStar, SaysWhereItBeginsInContact) {
  const Path road = straight_road(60, 5, 5);
  const std::vector<OrientedBox> beside = {box(1, 1.5, 4, 2)};
  const DrivableSpace space{.lanes = &road, .bodies = beside};
  EXPECT_EQ(find_way(car(), {Vec2(0, 0), 0}, {Vec2(30, 0), 0}, space).result,
            WaySearch::StartInContact);
  // nearer than the margin is no contact yet
  const WheeledShape shape = car();
  const std::vector<OrientedBox> near = {box(1, shape.width / 2 + 0.1 + 1, 4, 2)};
  const DrivableSpace narrow{.lanes = &road, .bodies = near};
  EXPECT_EQ(find_way(shape, {Vec2(0, 0), 0}, {Vec2(30, 0), 0}, narrow).result, WaySearch::Found);
}

TEST(HybridAStar, KeepsOffWalls) {
  const std::vector<Wall> walls = {{Vec2(15, -30), Vec2(15, 1)}};
  const FoundWay found = find_way(car(), {Vec2(0, 0), 0}, {Vec2(30, 0), 0}, {.walls = walls});
  ASSERT_EQ(found.result, WaySearch::Found);
  double highest = 0;
  for (const AxlePose& pose : found.poses) highest = std::max(highest, pose.position.y());
  EXPECT_GT(highest, 1 + car().width / 2);
}

}  // namespace
}  // namespace sumogamma
