#include "sumo/entry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sumogamma {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

TEST(Entry, PeopleWhosePlaceIsTakenStartFurtherAside) {
  EXPECT_THAT(entry_offsets(-0.3, -0.9, 0.9),
              ElementsAre(DoubleNear(-0.3, 1e-9), DoubleNear(-0.05, 1e-9), DoubleNear(-0.55, 1e-9),
                          DoubleNear(-0.8, 1e-9)));
}

TEST(Entry, PeopleStartNeitherAmongThoseWhoComeTowardsThemNorOffTheSidewalk) {
  for (const double offset : entry_offsets(-0.5, -1.1, 1.1)) {
    EXPECT_LT(offset, 0.0);
    EXPECT_GE(offset, -1.1);
  }
}

TEST(Entry, NobodyStartsInAWall) {
  Obstacle wall;
  wall.outline = {{-1, 1}, {1, 1}, {1, 2}, {-1, 2}};
  Model model;
  model.obstacles = ObstacleIndex({wall});
  AgentState agent;
  agent.footprint = box_footprint(0.4, 0.48);
  agent.position = {0, 0.9};
  EXPECT_TRUE(touches_wall(model, agent));
  agent.position = {0, 0.7};
  EXPECT_FALSE(touches_wall(model, agent));
}

}  // namespace
}  // namespace sumogamma
