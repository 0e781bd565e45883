#include "traffic/recovery/detour.h"

#include <gtest/gtest.h>

#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::read_plain_net;
using testing::RoadScene;
using testing::two_ways;

class DetourTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(two_ways(false));
    return network;
  }
  /// Somebody who has kept the junction A clear for that long [s], on its way by S.
  std::size_t add_waiting(const std::string& type, double kept) {
    const std::size_t row = here_.add(type, {"IA", "AS", "SD", "DO"}, 0, 0);
    here_.move(row, here_.path(row).links.front().stop_line - 8.0);
    here_.traffic.keeps_clear[row] = kept;
    return row;
  }
  /// Ticks until everybody has had a look.
  std::uint64_t look() {
    std::uint64_t taken = 0;
    for (int k = 0; k < 20; ++k) {
      taken += take_detours(here_.tick(alone_));
      ++here_.scene.tick;
    }
    return taken;
  }
  std::string lane_after(std::size_t row, double along) {
    return net().lane(here_.path(row).stretch_at(along).lane).name;
  }
  RoadScene here_{net()};
  Workers alone_;
};

TEST_F(DetourTest, WhoseWayIsShutForLongTakesAnother) {
  const std::size_t car = add_waiting("car", 25.0);
  const Vec2 place = here_.scene.position[car];
  ASSERT_EQ(look(), 1u);
  const Path& path = here_.path(car);
  EXPECT_EQ(net().edge(path.trip->route[1]).name, "AN");
  EXPECT_EQ(net().edge(path.trip->route.back()).name, "DO") << "to the same destination";
  EXPECT_EQ(lane_after(car, here_.scene.path_along[car]), "IA_0");
  EXPECT_LT((path.line.point_at(here_.scene.path_along[car]) - place).norm(), 0.1);
  EXPECT_EQ(here_.traffic.keeps_clear[car], 0.0);
  EXPECT_EQ(look(), 0u);
}

TEST_F(DetourTest, NotBeforeLong) {
  add_waiting("car", 10.0);
  EXPECT_EQ(look(), 0u);
}

TEST_F(DetourTest, BusesAndWhoHasStopsKeepTheirRoutes) {
  add_waiting("bus", 20.0);
  EXPECT_EQ(look(), 0u);
  const std::size_t car = add_waiting("car", 20.0);
  Path path = here_.path(car);
  path.stops.push_back({path.arrival - 20.0, 5.0});
  here_.road.paths[static_cast<std::size_t>(here_.scene.path[car])] =
      std::make_shared<const Path>(std::move(path));
  EXPECT_EQ(look(), 0u);
}

TEST_F(DetourTest, NobodyLeavesOneFullRoadForAnother) {
  add_waiting("car", 20.0);
  here_.add("car", {"AN", "ND", "DO"}, 5.0, 0.0);
  here_.update();
  EXPECT_EQ(look(), 0u);
}

TEST_F(DetourTest, WhoIsOnTheJunctionGoesOn) {
  const std::size_t car = add_waiting("car", 20.0);
  here_.move(car, here_.path(car).links.front().stop_line + 1.0);
  EXPECT_EQ(look(), 0u);
}

}  // namespace
}  // namespace sumogamma
