#include "ego/ego_detour.h"

#include <gtest/gtest.h>

#include "ego/ego_action.h"
#include "scene/extent.h"
#include "support/ego_scene.h"

namespace sumogamma {
namespace {

constexpr double kPeriod = 1.0 / 3.0;  // [s]

/// An ego on the outer of two lanes, and somebody who stands 25 m before it.
class EgoDetourTest : public ::testing::Test, protected testing::EgoScene {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = testing::read_plain_net(testing::crossroads("priority"));
    return network;
  }
  EgoDetourTest() : EgoScene(net()) {
    ego_ = here_.add("car", {"WC", "CE"}, 60, 4, 0, -1, "WC_0");
    here_.scene.control[ego_] = Control::Planned;
    goal_.position = here_.path(ego_).line.point_at(150);
  }
  std::size_t stand(const std::string& lane, Control control) {
    const std::size_t row = here_.add("car", {"WC", "CE"}, 85, 0, 0, -1, lane);
    here_.scene.control[row] = control;
    return row;
  }
  void look(int times) {
    for (int k = 0; k < times; ++k)
      detour_.look({here_.model, goal_, ego_, rules_}, kPeriod, here_.scene, here_.road);
  }

  EgoDetour detour_;
};

TEST_F(EgoDetourTest, PassesAParkedCar) {
  const std::size_t parked = stand("WC_0", Control::Parked);
  look(8);
  EXPECT_EQ(detour_.taken(), 0) << "it hasn't stood for 3 s yet";
  look(4);
  ASSERT_EQ(detour_.taken(), 1);
  EXPECT_EQ(detour_.missed(), 0);
  const PlannedVelocity drives = [&](const TrafficView& view, std::size_t row) {
    EgoAction action;
    action.acceleration = 1.0;
    return velocity_of(action, view.model, view.scene, row, {5.0, 0.0, 0.05});
  };
  double nearest = 1e9, farthest = 0;
  for (int tick = 0; tick < 400; ++tick) {
    if (tick % 7 == 0) look(1);
    look_about(world(), {.rules = rules_});
    advance_rows(world(), {.rules = rules_}, drives);
    nearest = std::min(nearest, separation(box_of(here_.scene, ego_), box_of(here_.scene, parked)));
    const Vec2& place = here_.scene.position[ego_];
    if (place.x() > -80) break;
    farthest = std::max(farthest, place.y() - here_.scene.position[parked].y());
  }
  EXPECT_GT(here_.scene.position[ego_].x(), -80) << "it has passed";
  EXPECT_GT(nearest, 0.3);
  EXPECT_GT(farthest, 2.0);
  const Path& path = here_.path(ego_);
  EXPECT_LT(path.line.project(goal_.position).distance, 0.01) << "it is back on its lanes";
}

TEST_F(EgoDetourTest, WaitsBehindWhoMayBeWaitingWhereThereAreRules) {
  stand("WC_0", Control::Gamma);
  look(20);
  EXPECT_EQ(detour_.taken() + detour_.missed(), 0);
  rules_ = false;
  look(1);
  EXPECT_EQ(detour_.taken(), 1);
}

TEST_F(EgoDetourTest, KeepsToItsLanesWhereNoWayLeadsPast) {
  stand("WC_0", Control::Parked);
  stand("WC_1", Control::Parked);
  const Path* before = here_.road.path(here_.scene.path[ego_]);
  look(20);
  EXPECT_EQ(detour_.taken(), 0);
  EXPECT_GE(detour_.missed(), 1);
  EXPECT_LE(detour_.missed(), 5) << "it searches once a second";
  EXPECT_EQ(here_.road.path(here_.scene.path[ego_]), before);
}

TEST_F(EgoDetourTest, LeavesAFreeWayAlone) {
  stand("WC_1", Control::Parked);
  const Path* before = here_.road.path(here_.scene.path[ego_]);
  look(20);
  EXPECT_EQ(detour_.taken() + detour_.missed(), 0);
  EXPECT_EQ(here_.road.path(here_.scene.path[ego_]), before);
}

}  // namespace
}  // namespace sumogamma
