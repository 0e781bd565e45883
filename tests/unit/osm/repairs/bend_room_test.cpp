#include "osm/repairs/bend_room.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace sumogamma::osm {
namespace {

using ::testing::Each;

/// Two directions along a line of 60 m, a bend of a right angle to the left, and 60 m more.
RoadBody bent(double radius, double straight = 60) {
  RoadBody body;
  body.edge = EdgeId{0};
  body.twin = EdgeId{1};
  body.drives = true;
  auto add = [&](double x, double y) {
    const Vec2 point(x, y);
    body.along.push_back(
        body.points.empty() ? 0.0 : body.along.back() + (point - body.points.back()).norm());
    body.points.push_back(point);
  };
  for (double x = -straight; x < 0; x += 4) add(x, -radius);
  for (int k = 0; k <= 18; ++k)
    add(radius * std::sin(k * kPi / 36), -radius * std::cos(k * kPi / 36));
  for (double y = 4; y <= straight; y += 4) add(radius, y);
  body.to = body.along.back();
  return body;
}

TEST(BendRoom, IsWhatANoseSweepsMoreThanItsLane) {
  const BendRoom room = room_in_bends(bent(15), false);
  const double most = -*std::min_element(room.edge.begin(), room.edge.end());
  EXPECT_NEAR(most, 8.7 * 8.7 / 30 - 0.3, 0.15);
  EXPECT_THAT(room.edge, Each(::testing::Le(0.0))) << "to the right: outwards";
  EXPECT_THAT(room.twin, Each(0.0)) << "at the inside";
  EXPECT_EQ(room.edge.front(), 0.0);
  EXPECT_EQ(room.edge.back(), 0.0);
}

TEST(BendRoom, WhereTrafficKeepsLeftTheOtherDirectionIsOutside) {
  const BendRoom right = room_in_bends(bent(15), false), left = room_in_bends(bent(15), true);
  EXPECT_EQ(left.twin, right.edge);
  EXPECT_THAT(left.edge, Each(0.0));
}

TEST(BendRoom, NeitherInGentleBendsNorOnOneWayRoadsNorBeyondWhatFits) {
  EXPECT_THAT(room_in_bends(bent(30), false).edge, Each(0.0));
  RoadBody one_way = bent(15);
  one_way.twin = kNoEdge;
  EXPECT_THAT(room_in_bends(one_way, false).edge, Each(0.0));
  const BendRoom hairpin = room_in_bends(bent(5), false);
  EXPECT_THAT(hairpin.edge, Each(::testing::Ge(-2.5)));
}

TEST(BendRoom, ComesAndGoesSlowlyAndLeavesNoneWhereLanesEnd) {
  for (const double straight : {60.0, 8.0}) {
    RoadBody body = bent(12, straight);
    body.from = 4;
    const BendRoom room = room_in_bends(body, false);
    for (std::size_t i = 1; i < body.along.size(); ++i)
      EXPECT_LE(std::abs(room.edge[i] - room.edge[i - 1]),
                (body.along[i] - body.along[i - 1]) / 6 + 1e-9);
    EXPECT_EQ(room.edge[0], 0.0);
    EXPECT_EQ(room.edge[1], 0.0);
  }
}

}  // namespace
}  // namespace sumogamma::osm
