#include <gtest/gtest.h>

#include "support/road_scene.h"
#include "traffic/longitudinal/car_following.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;

class OccupationTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("priority"));
    return network;
  }
  /// A car that drives at 12 m/s, its front `before` metres before its first link.
  std::size_t add_before_line(const std::vector<std::string>& edges, double before) {
    const std::size_t row = here_.add("car", edges, 0, 12);
    here_.move(row, here_.path(row).links.front().stop_line - 2.25 - before);
    here_.update();
    return row;
  }
  RoadScene here_{net()};
};

TEST_F(OccupationTest, OnAStraightRoadTimeIsThatOfTheFastestWay) {
  const std::size_t row = add_before_line({"WC", "CE"}, 60);
  const Path& path = here_.path(row);
  const double along = here_.scene.path_along[row], top = path.profile_at(along);
  for (const double way : {0.0, 5.0, 30.0})
    EXPECT_NEAR(time_to_drive(TrafficParameters{}, path, along, along + way, {4, top, 2}),
                time_to_cover(way, 4, top, 2), 0.02);
  EXPECT_GT(time_to_drive(TrafficParameters{}, path, along, along + 30, {4, 6, 2}),
            time_to_drive(TrafficParameters{}, path, along, along + 30, {4, top, 2}))
      << "nobody drives faster than it likes to";
}

TEST_F(OccupationTest, WhoTurnsSlowsDownBeforeAndComesLater) {
  const std::size_t straight = add_before_line({"WC", "CE"}, 30);
  const std::size_t turning = add_before_line({"WC", "CN"}, 30);
  EXPECT_GT(here_.occupation_of(turning, 6, 10).begin,
            here_.occupation_of(straight, 6, 10).begin + 0.5);
  EXPECT_GT(here_.occupation_of(turning, 6, 10).end,
            here_.occupation_of(straight, 6, 10).end + 0.5);
}

TEST_F(OccupationTest, EndsWhereTheRearHasPassed) {
  const std::size_t row = add_before_line({"WC", "CE"}, -8);
  EXPECT_EQ(here_.occupation_of(row, 1, 3).begin, Occupation::kNever);
  const Occupation under_way = here_.occupation_of(row, 4, 6);
  EXPECT_EQ(under_way.begin, 0.0);
  EXPECT_GT(under_way.end, 0.0);
  EXPECT_LT(under_way.end, 1.0);
}

TEST_F(OccupationTest, WhoStandsInItStays) {
  const std::size_t row = add_before_line({"WC", "CE"}, -8);
  here_.set_speed(row, 0);
  EXPECT_EQ(here_.occupation_of(row, 4, 6).begin, 0.0);
  EXPECT_EQ(here_.occupation_of(row, 4, 6).end, Occupation::kNever);
}

}  // namespace
}  // namespace sumogamma
