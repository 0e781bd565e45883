#include "geometry/box_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sumogamma {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(BoxGrid, FindsWhatTouchesTheCells) {
  BoxGrid grid(10.0);
  grid.add(7, {1, 1}, {25, 2});
  grid.add(3, {-5, -5}, {5, 5});
  EXPECT_THAT(grid.at({2, 2}), ElementsAre(7, 3)) << "as they were added";
  EXPECT_THAT(grid.at({-1, -1}), ElementsAre(3));
  EXPECT_THAT(grid.at({31, 2}), IsEmpty());
  EXPECT_THAT(grid.near({-20, -20}, {30, 30}), ElementsAre(3, 7)) << "each once, ascending";
  EXPECT_THAT(grid.near({21, 0}, {29, 9}), ElementsAre(7));
  EXPECT_THAT(grid.near({100, 100}, {101, 101}), IsEmpty());
}

}  // namespace
}  // namespace sumogamma
