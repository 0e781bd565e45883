#include "sumo/ghosts.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "sumo/loop_detectors.h"

namespace sumogamma {
namespace {

/// Cars, 4.5 by 1.8 m, on a plane: the first is SUMO's, the rest are ghosts.
class Ghosts : public ::testing::Test {
 protected:
  std::size_t add(const Vec2& position, double heading, double speed) {
    AgentState agent;
    agent.id = AgentId{static_cast<std::uint32_t>(scene_.size())};
    agent.type = find_agent_type(types_, "car");
    agent.footprint = box_footprint(4.5, 1.8);
    agent.position = position;
    agent.heading = heading;
    agent.speed = speed;
    agent.control = scene_.size() == 0 ? Control::External : Control::Gamma;
    append_agent(scene_, agent);
    grid_.rebuild(scene_.position);
    return scene_.size() - 1;
  }
  double speed_behind(std::size_t ghost) const {
    const std::uint32_t ghosts[] = {static_cast<std::uint32_t>(ghost)};
    return speed_behind_ghosts(scene_, 0, false, nullptr, ghosts);
  }

  AgentTypeTable types_ = default_agent_types();
  Scene scene_;
  SpatialGrid grid_;
};

TEST_F(Ghosts, BodiesTouchFromFiveCentimetres) {
  add({0, 0}, 0, 0);
  add({4.56, 0}, 0, 0);
  EXPECT_FALSE(touches(scene_, 0));
  scene_.position[1].x() = 4.54;
  EXPECT_TRUE(touches(scene_, 0));
}

TEST_F(Ghosts, WhoClosesInNeedsRoom) {
  add({0, 0}, 0, 10);
  add({20, 0}, 0, 10);
  EXPECT_TRUE(has_room_for(scene_, grid_, 0)) << "at the same speed";
  scene_.velocity[1] = Vec2(0, 0);
  EXPECT_FALSE(has_room_for(scene_, grid_, 0)) << "it stands: 4 m of reaction and 14 m of braking";
  scene_.position[1].y() = 4;
  EXPECT_TRUE(has_room_for(scene_, grid_, 0)) << "beside its lane";
  scene_.position[1].y() = 0;
  scene_.height[1] = 5;
  EXPECT_TRUE(has_room_for(scene_, grid_, 0)) << "on a bridge";
}

TEST_F(Ghosts, NobodyIsFasterThanWhoIsAheadAllows) {
  add({0, 0}, 0, 10);
  const std::size_t ghost = add({12, 0}, 0, 0);
  const double before_standing = speed_behind(ghost);
  EXPECT_GT(before_standing, 0.0);
  EXPECT_LT(before_standing, 10.0);
  scene_.speed[ghost] = 8;
  scene_.velocity[ghost] = Vec2(8, 0);
  EXPECT_GT(speed_behind(ghost), before_standing);
  scene_.position[ghost].y() = 3;
  EXPECT_TRUE(std::isinf(speed_behind(ghost))) << "beside its way";
}

TEST_F(Ghosts, WhoIsCloseBesideOneGetsNoCloser) {
  add({0, 0}, 0, 1);
  const std::size_t ghost = add({3, 1.85}, 0, 0);
  EXPECT_TRUE(std::isinf(speed_behind(ghost))) << "along it";
  scene_.heading[0] = 0.3;
  scene_.position[0].y() = -0.6;
  EXPECT_EQ(speed_behind(ghost), 0.0) << "into it";
  scene_.position[0].y() = 0.6;
  EXPECT_TRUE(std::isinf(speed_behind(ghost))) << "out of it";
}

TEST_F(Ghosts, OvertakingTakesALongStretchFreeOfGhosts) {
  add({0, 0}, 0, 10);
  add({120, 3}, kPi, 10);
  EXPECT_TRUE(meets_ghosts(scene_, grid_, 0));
  scene_.position[1].x() = -30;
  grid_.rebuild(scene_.position);
  EXPECT_FALSE(meets_ghosts(scene_, grid_, 0)) << "behind it";
}

TEST_F(Ghosts, LoopsAreToldWhenABodyWasLastOnThem) {
  add({0, 0}, 0, 0);
  add({0, 0}, 0, 0);
  const LaneId lane{3};
  scene_.lane[1] = {lane, 48, 0};
  std::vector<KnownAgent> known(2);
  known[0].length = known[1].length = 4.5;
  LoopDetectors detectors;
  detectors.loops[lane] = {{0, 50, 0}, {1, 60, 0}};
  detectors.ages = {{"near", 0}, {"far", 0}};
  note_passages(scene_, known, 7, detectors);
  EXPECT_EQ(detectors.ages[0].second, 0) << "the front is on it";
  EXPECT_EQ(detectors.ages[1].second, 7);
  known[1].is_person = true;
  note_passages(scene_, known, 9, detectors);
  EXPECT_EQ(detectors.ages[0].second, 2);
}

}  // namespace
}  // namespace sumogamma
