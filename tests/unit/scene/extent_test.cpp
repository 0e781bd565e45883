#include "scene/extent.h"

#include <gtest/gtest.h>

#include "support/road_scene.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::RoadScene;

TEST(HalfExtent, IsOfTheTurnedBox) {
  RoadScene here(testing::small_net());
  const std::size_t own = here.add("car", {"in", "out"}, 5, 2);
  EXPECT_NEAR(half_extent(here.scene, own, Vec2(1, 0)), 2.25, 1e-12);
  EXPECT_NEAR(half_extent(here.scene, own, Vec2(0, 1)), 0.9, 1e-12);
  here.scene.heading[own] = kPi / 2;
  EXPECT_NEAR(half_extent(here.scene, own, Vec2(1, 0)), 0.9, 1e-12);
}

}  // namespace
}  // namespace sumogamma
