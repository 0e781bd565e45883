#include "geometry/segment.h"

#include <gtest/gtest.h>

namespace sumogamma {
namespace {

TEST(Segment, DistanceOfAPoint) {
  EXPECT_DOUBLE_EQ(distance_to_segment({0, 0}, {4, 0}, {2, 3}), 3.0);
  EXPECT_DOUBLE_EQ(distance_to_segment({0, 0}, {4, 0}, {7, 4}), 5.0) << "beyond its end";
  EXPECT_DOUBLE_EQ(distance_to_segment({1, 1}, {1, 1}, {4, 5}), 5.0) << "no length";
}

TEST(Segment, DistanceOfTwo) {
  EXPECT_DOUBLE_EQ(distance_of_segments({0, 0}, {4, 0}, {2, -1}, {2, 1}), 0.0) << "they cross";
  EXPECT_DOUBLE_EQ(distance_of_segments({0, 0}, {4, 0}, {2, 1}, {2, 5}), 1.0);
  EXPECT_DOUBLE_EQ(distance_of_segments({0, 0}, {4, 0}, {0, 2}, {4, 2}), 2.0) << "side by side";
  EXPECT_DOUBLE_EQ(distance_of_segments({0, 0}, {4, 0}, {7, 4}, {9, 9}), 5.0);
  EXPECT_DOUBLE_EQ(distance_of_segments({0, 0}, {4, 0}, {6, 0}, {9, 0}), 2.0) << "in one line";
}

TEST(Segment, StretchInABox) {
  const Vec2 low(0, 0), high(10, 5);
  const auto through = stretch_in_box({-10, 1}, {30, 1}, low, high);
  ASSERT_TRUE(through);
  EXPECT_DOUBLE_EQ(through->from, 0.25);
  EXPECT_DOUBLE_EQ(through->to, 0.5);
  const auto inside = stretch_in_box({1, 1}, {2, 4}, low, high);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->from, 0.0);
  EXPECT_EQ(inside->to, 1.0);
  EXPECT_FALSE(stretch_in_box({-10, 6}, {30, 6}, low, high)) << "beside it";
  EXPECT_FALSE(stretch_in_box({-2, 3}, {3, -2 - 4}, low, high)) << "past a corner";
  EXPECT_FALSE(stretch_in_box({12, 1}, {14, 1}, low, high)) << "before it";
}

}  // namespace
}  // namespace sumogamma
