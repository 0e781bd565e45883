#include "geometry/simplify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/vec2.h"

namespace sumogamma {
namespace {

using ::testing::ElementsAre;

TEST(NeededPoints, LeavesOutWhatAStraightLineDoesNotNeed) {
  const std::vector<Vec2> points = {{0, 0}, {5, 0.04}, {10, 0}, {10, 5}, {10, 10}};
  EXPECT_THAT(needed_points(points, 0.05), ElementsAre(true, false, true, false, true));
  EXPECT_THAT(needed_points(points, 0.01), ElementsAre(true, true, true, false, true));
}

TEST(NeededPoints, KeepsTheFarthestOfARingAndHeights) {
  const std::vector<Vec2> ring = {{0, 0}, {10, 0}, {10, 10}, {0, 0}};
  EXPECT_THAT(needed_points(ring, 0.05), ElementsAre(true, true, true, true));
  const std::vector<Eigen::Vector3d> hill = {{0, 0, 0}, {10, 0, 1}, {20, 0, 0}};
  EXPECT_THAT(needed_points(hill, 0.05), ElementsAre(true, true, true));
}

TEST(NeededPoints, OneOrNone) {
  EXPECT_THAT(needed_points(std::vector<Vec2>{{1, 2}}, 0.1), ElementsAre(true));
  EXPECT_TRUE(needed_points(std::vector<Vec2>{}, 0.1).empty());
}

}  // namespace
}  // namespace sumogamma
