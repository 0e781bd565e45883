#include "traffic/longitudinal/merging.h"

#include <gtest/gtest.h>

#include "support/road_scene.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::RoadScene;

TEST(BrakingAsked, IsTheHarderTheCloserSomebodyIsCutInOn) {
  RoadScene here(testing::small_net());
  const std::size_t own = here.add("car", {"in", "out"}, 90, 0);
  const AgentType& type = type_of(here.model.types, here.scene.type[own]);
  const Path& path = here.path(own);
  auto asked = [&](double to_merged, double speed) {
    // both on ways like this one, whose places at 100 m are the same
    return braking_asked(TrafficParameters{}, {type, path, 92, 4.5, 0, 13, 100}, 95,
                         {type, path, 20, 4.5, speed, speed, 20 + to_merged});
  };
  EXPECT_EQ(asked(200, 12), 0.0);
  EXPECT_GT(asked(45, 12), 1.0);
  EXPECT_LT(asked(60, 12), asked(45, 12));
  EXPECT_TRUE(std::isinf(asked(10, 12)));
  EXPECT_LT(asked(30, 3), 1.0);  // slow traffic lets in at ease
}

}  // namespace
}  // namespace sumogamma
