#include "geometry/heading.h"

#include <gtest/gtest.h>

#include <vector>

namespace sumogamma {
namespace {

TEST(Heading, KeepsTheDirectionOfItsAngle) {
  EXPECT_EQ(direction_of(Heading()), direction_of(0.0));
  std::vector<Heading> headings(3);
  for (const double angle : {0.0, -0.0, 0.3, -2.5, 3.1415, 7.0, -100.0}) {
    headings[1] = angle;
    EXPECT_EQ(static_cast<double>(headings[1]), angle);
    EXPECT_EQ(direction_of(headings[1]), direction_of(angle));
    EXPECT_EQ(direction_of(headings[1] + 0.5), direction_of(angle + 0.5));
  }
}

}  // namespace
}  // namespace sumogamma
