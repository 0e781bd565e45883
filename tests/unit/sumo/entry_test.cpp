#include "sumo/entry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sumo/sumo_agents.h"
#include "support/road_scene.h"
#include "support/small_net.h"

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
  EXPECT_TRUE(is_walled_off(model, agent, {0, 0}));
  agent.position = {0, 0.7};
  EXPECT_FALSE(is_walled_off(model, agent, {0, 0}));
}

// whoever began inside a house went to and fro before its walls for the rest of the run
TEST(Entry, NobodyStartsInsideAHouse) {
  Obstacle house;
  house.outline = {{-5, 1}, {5, 1}, {5, 9}, {-5, 9}};
  Model model;
  model.obstacles = ObstacleIndex({house});
  AgentState agent;
  agent.footprint = box_footprint(0.4, 0.48);
  agent.position = {0, 2};
  EXPECT_TRUE(is_walled_off(model, agent, {0, 0}));
  EXPECT_FALSE(is_walled_off(model, agent, {0, 3})) << "as in a station";
}

// Who found its lane full began on the one beside it, 256 m before a light at which that one turned
// off: half of its queue went straight on, and those who turned waited behind them.
TEST(Entry, NobodyStartsOnALaneThatEndsBeforeItsWayDoes) {
  testing::PlainNet net;
  net.nodes =
      "<node id='W' x='0' y='0'/><node id='M' x='400' y='0'/><node id='E' x='900' y='0'/>"
      "<node id='N' x='400' y='300'/>";
  net.edges =
      "<edge id='WM' from='W' to='M' numLanes='3' speed='13.89'/>"
      "<edge id='ME' from='M' to='E' numLanes='2' speed='13.89'/>"
      "<edge id='MN' from='M' to='N' numLanes='1' speed='13.89'/>";
  net.connections =
      "<connection from='WM' to='ME' fromLane='0' toLane='0'/>"
      "<connection from='WM' to='ME' fromLane='1' toLane='1'/>"
      "<connection from='WM' to='MN' fromLane='2' toLane='0'/>";
  Model model;
  model.types = default_agent_types();
  model.road = testing::read_plain_net(net);
  SumoAgentDetails details;
  details.vehicle_class = "passenger";
  details.lane = "WM_1";
  details.route = {"WM", "ME"};
  const AgentTypeId car = find_agent_type(model.types, "car");
  std::string why;
  const auto path = path_of(model, details, car, why);
  ASSERT_TRUE(path) << why;
  const auto besides = paths_besides(model, details, car, *path);
  ASSERT_EQ(besides.size(), 1u);
  EXPECT_EQ(model.road.lane(besides.front()->stretches.front().lane).name, "WM_0");
}

class EntryTest : public ::testing::Test {
 protected:
  std::optional<double> speed_of_newcomer() { return speed_of_newcomer_like(first_, 13.0); }
  /// Somebody who starts on the path of a row and is of its kind.
  std::optional<double> speed_of_newcomer_like(std::size_t row, double preferred) {
    const Path& path = here_.path(row);
    AgentState agent;
    agent.type = here_.scene.type[row];
    agent.footprint = here_.scene.footprint[row];
    agent.position = path.line.point_at(0.0);
    agent.heading = heading_of(path.line.direction_at(0.0));
    agent.preferred_speed = preferred;
    SpatialGrid grid;
    grid.rebuild(here_.scene.position);
    return entry_speed({here_.model, here_.road, here_.scene, grid}, path, agent, Ground{}, most_,
                       blocker_);
  }
  /// Puts a row so far from where newcomers start.
  void put(std::size_t row, const Vec2& away, double heading, double speed) {
    here_.scene.position[row] = here_.path(first_).line.point_at(0.0) + away;
    here_.scene.heading[row] = heading;
    here_.set_speed(row, speed);
  }
  testing::RoadScene here_{testing::small_net()};
  std::size_t first_ = here_.add("car", {"in", "out"}, 120, 10);
  double most_ = std::numeric_limits<double>::infinity();  // [m/s]
  std::optional<AgentId> blocker_;
};

TEST_F(EntryTest, AFreePlaceIsTaken) { EXPECT_TRUE(speed_of_newcomer()); }

TEST_F(EntryTest, NobodyStartsFasterThanItsDepartureAllows) {
  EXPECT_GT(*speed_of_newcomer(), 5.0);
  most_ = 5.0;
  EXPECT_EQ(*speed_of_newcomer(), 5.0);
  // standing is no reason to brake for whoever stands behind
  most_ = 0.0;
  const std::size_t behind = here_.add("car", {"in", "out"}, 0, 0);
  put(behind, Vec2(-9, 0), 0, 0);
  EXPECT_EQ(*speed_of_newcomer(), 0.0);
}

TEST_F(EntryTest, WhoIsInTheWayIsLookedAtFirst) {
  const std::size_t other = here_.add("car", {"in", "out"}, 0, 0);
  EXPECT_FALSE(speed_of_newcomer());
  ASSERT_TRUE(blocker_);
  EXPECT_EQ(*blocker_, here_.scene.id[other]);
  EXPECT_FALSE(speed_of_newcomer()) << "it still is";
  put(other, Vec2(200, 0), 0, 0);
  EXPECT_TRUE(speed_of_newcomer());
  EXPECT_FALSE(blocker_);
}

TEST_F(EntryTest, NobodyStartsInFrontOfWhoComesAcross) {
  const std::size_t other = here_.add("car", {"in", "out"}, 0, 0);
  // 12 m aside of the place, on its way over it
  const Vec2 start = here_.path(first_).line.point_at(0.0);
  here_.scene.position[other] = start + Vec2(0, 12);
  here_.scene.heading[other] = -0.5 * kPi;
  here_.set_speed(other, 0.0);
  EXPECT_TRUE(speed_of_newcomer()) << "it stands";
  here_.set_speed(other, 7.0);
  EXPECT_FALSE(speed_of_newcomer());
  here_.scene.heading[other] = 0.5 * kPi;
  here_.set_speed(other, 7.0);
  EXPECT_TRUE(speed_of_newcomer()) << "it goes away";
}

// who turns into the lane from a junction comes at an angle: a motorcycle began beside its nose
TEST_F(EntryTest, NorInFrontOfWhoTurnsIn) {
  const std::size_t other = here_.add("car", {"in", "out"}, 0, 0);
  put(other, Vec2(-6.0, 3.5), -0.5, 5.0);
  EXPECT_FALSE(speed_of_newcomer());
  put(other, Vec2(-6.0, 3.5), 0.5, 5.0);
  EXPECT_TRUE(speed_of_newcomer()) << "it turns away";
}

// a bicycle began right before the nose of a car that came out of a bend
TEST_F(EntryTest, NorInFrontOfWhoComesOutOfABend) {
  const std::size_t other = here_.add("car", {"in", "out"}, 0, 0);
  here_.scene.path[other] = kNoPath;
  put(other, Vec2(-9.0, 2.4), -0.25, 9.0);
  EXPECT_FALSE(speed_of_newcomer());
  put(other, Vec2(-9.0, 2.4), 0.0, 9.0);
  EXPECT_TRUE(speed_of_newcomer()) << "it passes beside";
}

// a motorcycle began to drive at 10 m/s beside the tail of a bus that turned across its way
TEST_F(EntryTest, NorBesideWhoTurnsAcrossItsWay) {
  const std::size_t other = here_.add("car", {"in", "out"}, 0, 0);
  const Vec2 start = here_.path(first_).line.point_at(0.0);
  here_.scene.lane[other] = {};  // no leader
  here_.scene.position[other] = start + Vec2(8.0, 4.5);
  here_.scene.heading[other] = -0.5;
  here_.set_speed(other, 5.0);
  EXPECT_FALSE(speed_of_newcomer());
  here_.scene.position[other] = start + Vec2(25.0, 4.5);
  EXPECT_TRUE(speed_of_newcomer()) << "there is time to see it";
  // the other direction of a road that bends
  here_.scene.position[other] = start + Vec2(8.0, 4.5);
  here_.scene.heading[other] = kPi + 0.2;
  here_.set_speed(other, 5.0);
  EXPECT_TRUE(speed_of_newcomer());
}

// a car began to drive beside a lorry whose nose still swung over its lane in the bend behind a
// junction
TEST_F(EntryTest, NorBesideWhoIsStillTurningIntoTheNextLane) {
  const std::size_t other = here_.add("truck", {"in", "out"}, 0, 0);
  const Vec2 start = here_.path(first_).line.point_at(0.0) + Vec2(-4.0, 3.7);
  Path beside = here_.path(other);
  beside.line = Polyline({start, start + Vec2(100.0, 0.0)});
  here_.road.paths[static_cast<std::size_t>(here_.scene.path[other])] =
      std::make_shared<const Path>(beside);
  here_.scene.lane[other] = {};
  here_.scene.path_along[other] = 0.0;
  here_.scene.position[other] = start;
  const auto may_start = [&](double turned) {
    here_.scene.heading[other] = turned;
    here_.set_speed(other, 7.0);
    return speed_of_newcomer().has_value();
  };
  EXPECT_FALSE(may_start(-0.36));
  EXPECT_TRUE(may_start(0.0)) << "it drives beside";
}

// its middle was in the next lane already, and a car began with 8 m/s two metres behind its tail
TEST_F(EntryTest, NorFastBehindALongBodyWhoseTailIsStillInItsLane) {
  const std::size_t bus = here_.add("bus", {"in", "out"}, 0, 0);
  here_.scene.lane[bus] = {};
  const auto speed_with_it = [&](double turned) {
    put(bus, Vec2(11.0, 2.9), turned, 1.0);
    return speed_of_newcomer().value_or(0.0);
  };
  EXPECT_LT(speed_with_it(0.28), 2.0);
  EXPECT_GT(speed_with_it(0.0), 5.0) << "it drives beside";
}

TEST_F(EntryTest, NobodyOnFootStartsBeforeWhoDrives) {
  const std::size_t walker = here_.add("pedestrian", {"in"}, 10, 0);
  const Polyline& way = here_.path(walker).line;
  const std::size_t bicycle = here_.add("bicycle", {"in", "out"}, 0, 0);
  here_.scene.position[bicycle] = way.point_at(0.0) - 8.0 * way.direction_at(0.0);
  here_.scene.heading[bicycle] = heading_of(way.direction_at(0.0));
  here_.set_speed(bicycle, 6.0);
  EXPECT_FALSE(speed_of_newcomer_like(walker, 1.3));
  here_.set_speed(bicycle, 0.0);
  EXPECT_TRUE(speed_of_newcomer_like(walker, 1.3)) << "it stands";
}

TEST_F(EntryTest, WhoChangesIntoTheLaneAheadIsFollowed) {
  const double alone = *speed_of_newcomer();
  const std::size_t other = here_.add("car", {"in", "out"}, 0, 0);
  here_.move(other, 18.0, 3.2);
  here_.set_speed(other, 3.0);
  EXPECT_EQ(speed_of_newcomer(), alone) << "it keeps to the lane beside";
  here_.scene.lane[other].lane = here_.path(first_).stretches.front().lane;
  const auto behind = speed_of_newcomer();
  EXPECT_TRUE(!behind || *behind < 0.7 * alone);
}

}  // namespace
}  // namespace sumogamma
