#include "validation/walk_room.h"

#include <gtest/gtest.h>

namespace sumogamma {
namespace {

TEST(WalkRoom, SomebodyAloneKeepsItsSpeedAndLeavesThroughTheGate) {
  Room room;
  room.walls = {{{-1, 0}, {22, 0}}, {{-1, 2}, {22, 2}}};
  room.walkers = {{{0, 1}, 1.2, {{{10, 0}, {10, 2}}, {{20, 0}, {20, 2}}}, 3.0}};
  Workers workers;
  std::size_t there = 0;
  const auto walked = walk(room, 40.0, workers,
                           [&](double, const Scene&, std::size_t walkers) { there = walkers; });
  EXPECT_NEAR(walked[0].started, 3.0, 0.5);
  ASSERT_EQ(walked[0].passed.size(), 2u);
  EXPECT_NEAR(walked[0].passed[1] - walked[0].passed[0], 10.0 / 1.2, 0.2);
  EXPECT_NEAR(walked[0].passed[1], 3.0 + 20.0 / 1.2, 1.0);
  EXPECT_EQ(there, 1u) << "the last step that it was there";
}

// they shuffled about on the spot for ever: who is near ahead stands, too, at the beginning
TEST(WalkRoom, ACrowdThatStandsCloseSetsOff) {
  Room room;
  room.period = 26.0;
  room.walls = {{{-26, 0}, {52, 0}}, {{-26, 2}, {52, 2}}};
  for (int line = 0; line < 3; ++line)
    for (int column = 0; column < 35; ++column)
      room.walkers.push_back({{26.0 * (column + 0.5) / 35, 2.0 * (line + 0.5) / 3}, 1.34, {}, 0.0});
  Workers workers;
  double speed = 0.0;
  walk(room, 6.0, workers, [&](double, const Scene& scene, std::size_t walkers) {
    speed = 0.0;
    for (std::size_t row = 0; row < walkers; ++row)
      speed += scene.velocity[row].x() / static_cast<double>(walkers);
  });
  EXPECT_GT(speed, 0.35) << "Weidmann has 0.61 m/s at two people a square metre, ± 0.26";
}

// the ground is repeated: who leaves it on the right comes in on the left, and is seen across
TEST(WalkRoom, OnARepeatedGroundPeopleSeeEachOtherAcrossItsEnd) {
  Room room;
  room.period = 10.0;
  room.walls = {{{-10, 0}, {20, 0}}, {{-10, 0.9}, {20, 0.9}}};
  room.walkers = {{{9.0, 0.45}, 0.3, {}, 0.0}, {{5.0, 0.45}, 1.5, {}, 0.0}};
  Workers workers;
  double least = 10.0;
  walk(room, 30.0, workers, [&](double, const Scene& scene, std::size_t) {
    double gap = scene.position[0].x() - scene.position[1].x();
    gap -= 10.0 * std::floor(gap / 10.0);
    least = std::min(least, gap);
  });
  EXPECT_GT(least, 0.35) << "walked through";
}

}  // namespace
}  // namespace sumogamma
