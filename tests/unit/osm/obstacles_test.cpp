#include "osm/obstacles.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <pugixml.hpp>

#include "base/error.h"
#include "osm/lane_clearing.h"
#include "road/sumo_net_reader.h"
#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

/// A network of one straight lane from (-100, 0) to (100, 0), 4 m wide.
RoadNetwork one_lane(VehicleClassMask allowed = vehicle_class::kPassenger) {
  RoadNetwork road;
  Lane lane;
  lane.allowed = allowed;
  lane.width = 4.0;
  lane.centerline = Polyline({Vec2(-100, 0), Vec2(100, 0)});
  road.lanes.push_back(lane);
  return road;
}

double area_of(const std::vector<Vec2>& ring) {
  double twice = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    twice += ring[j].x() * ring[i].y() - ring[i].x() * ring[j].y();
  return std::abs(twice) / 2;
}

TEST(LaneClearing, TellsWhereASegmentLiesOnALane) {
  const LaneClearing clearing(one_lane());
  const auto across = clearing.stretches_on_lanes(Vec2(10, -10), Vec2(10, 10));
  ASSERT_EQ(across.size(), 1u);
  EXPECT_NEAR(across[0].from, 0.4, 1e-9);
  EXPECT_NEAR(across[0].to, 0.6, 1e-9);
  EXPECT_TRUE(clearing.stretches_on_lanes(Vec2(-50, 3), Vec2(50, 3)).empty());
  const auto along = clearing.stretches_on_lanes(Vec2(-50, 1), Vec2(50, 1));
  ASSERT_EQ(along.size(), 1u);
  EXPECT_DOUBLE_EQ(along[0].from, 0);
  EXPECT_DOUBLE_EQ(along[0].to, 1);
}

TEST(LaneClearing, SidewalksNeedLessThanTheirWidth) {
  const LaneClearing clearing(one_lane(vehicle_class::kPedestrian));
  EXPECT_TRUE(clearing.stretches_on_lanes(Vec2(-50, 1), Vec2(50, 1)).empty());
  // two abreast and somebody who comes towards them get past each other
  EXPECT_FALSE(clearing.stretches_on_lanes(Vec2(-50, 0.75), Vec2(50, 0.75)).empty());
}

//   sidewalk ------+   +------ crossing    the outlines of the lanes and of the walking area need
//   not
//                   \_ /                    cover the straight way from one to the other
TEST(LaneClearing, TheWaysOverAWalkingAreaCount) {
  RoadNetwork road = one_lane(vehicle_class::kPedestrian);
  Lane crossing = road.lanes.front();
  crossing.kind = LaneKind::Crossing;
  crossing.centerline = Polyline({Vec2(110, 0), Vec2(120, 0)});
  Lane area;
  area.kind = LaneKind::WalkingArea;
  area.outline = {{100, -1}, {110, -1}, {105, -3}};
  area.incoming = {ConnectionId{0}};
  area.outgoing = {ConnectionId{1}};
  road.lanes.push_back(crossing);
  road.lanes.push_back(area);
  Connection in, out;
  in.from = LaneId{0};
  in.to = out.from = LaneId{2};
  out.to = LaneId{1};
  road.connections = {in, out};
  const LaneClearing clearing(road);
  EXPECT_FALSE(clearing.stretches_on_lanes(Vec2(105, -0.5), Vec2(105, 0.5)).empty());
  EXPECT_TRUE(clearing.stretches_on_lanes(Vec2(105, 0.8), Vec2(105, 2)).empty());
}

TEST(LaneClearing, KnowsWhatTouchesALane) {
  const LaneClearing clearing(one_lane());
  EXPECT_TRUE(clearing.touches_lane(Vec2(0, 2.2), 0.3));
  EXPECT_FALSE(clearing.touches_lane(Vec2(0, 2.4), 0.3));
  EXPECT_FALSE(clearing.touches_lane(Vec2(150, 0), 0.3));
}

class ObstaclesTest : public ::testing::Test {
 protected:
  ObstaclesTest() : projection_(local_projection(builder_.origin)) {
    file_ =
        std::filesystem::temp_directory_path() /
        ("obstacles_" +
         std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".add.xml");
  }
  ~ObstaclesTest() override { std::filesystem::remove(file_); }

  /// A building from corner to corner [m].
  void add_building(double west, double south, double east, double north, Tags tags = {},
                    MapArea::Ring inner = {}) {
    tags["building"] = tags.contains("building") ? tags["building"] : "yes";
    MapArea area{"way/" + std::to_string(builder_.map.areas.size() + 1), std::move(tags), {}};
    MapArea::Part part{{builder_.at(west, south), builder_.at(east, south),
                        builder_.at(east, north), builder_.at(west, north)},
                       {}};
    if (!inner.empty()) part.inner.push_back(std::move(inner));
    area.parts.push_back(part);
    builder_.map.areas.push_back(area);
  }
  /// Written, and read back as the simulator does.
  std::vector<Obstacle> written(const RoadNetwork& road = one_lane()) {
    counts_ = write_obstacles(builder_.map, projection_, road, builder_.box(-500, -500, 500, 500),
                              file_, builder_.log);
    RoadNetwork read;
    read_obstacles(file_, read);
    return read.obstacles;
  }

  MapBuilder builder_;
  GeoProjection projection_;
  std::filesystem::path file_;
  std::map<std::string, long> counts_;
};

TEST_F(ObstaclesTest, ABuildingOffTheRoadStaysWhole) {
  add_building(10, 10, 30, 25);
  const auto obstacles = written();
  ASSERT_EQ(obstacles.size(), 1u);
  EXPECT_EQ(obstacles[0].kind, ObstacleKind::Building);
  EXPECT_EQ(obstacles[0].outline.size(), 4u);
  EXPECT_NEAR(area_of(obstacles[0].outline), 300,
              3);  // the sphere of the builder against PROJ's ellipsoid
  EXPECT_EQ(counts_.at("buildings"), 1);
}

TEST_F(ObstaclesTest, ABuildingOverTheRoadIsCutInTwo) {
  add_building(10, -10, 30, 10);
  const auto obstacles = written();
  ASSERT_EQ(obstacles.size(), 2u);
  for (const Obstacle& obstacle : obstacles) {
    EXPECT_NEAR(area_of(obstacle.outline), 160, 2);
    for (const Vec2& p : obstacle.outline) EXPECT_GE(std::abs(p.y()), 2.0 - 0.01);
  }
  EXPECT_EQ(counts_.at("buildings_cut"), 1);
}

TEST_F(ObstaclesTest, ABuildingOnTheRoadAloneIsLeftOut) {
  add_building(10, -1, 30, 1);
  EXPECT_TRUE(written().empty());
  EXPECT_EQ(counts_.at("left_out_on_lane"), 1);
}

TEST_F(ObstaclesTest, ACourtyardIsNotFilled) {
  add_building(
      10, 10, 40, 40, {},
      {builder_.at(20, 20), builder_.at(30, 20), builder_.at(30, 30), builder_.at(20, 30)});
  const auto obstacles = written();
  ASSERT_EQ(obstacles.size(), 1u);
  EXPECT_NEAR(std::abs(area_of(obstacles[0].outline)), 800, 8);
}

TEST_F(ObstaclesTest, WhatIsNotAtStreetLevelIsLeftOut) {
  add_building(10, 10, 30, 25, {{"layer", "1"}});
  add_building(10, 10, 30, 25, {{"building", "roof"}});
  add_building(10, 10, 30, 25, {{"location", "underground"}});
  add_building(10, 10, 30, 25, {{"building:min_level", "2"}});
  add_building(10, 10, 30, 25, {{"min_height", "4.5 m"}});
  EXPECT_TRUE(written().empty());
  EXPECT_EQ(counts_.at("left_out_level"), 5);
}

TEST_F(ObstaclesTest, AWallIsCutWhereALanePasses) {
  builder_.node(1, 0, -10).node(2, 0, 10).way(10, {1, 2}, {{"barrier", "wall"}});
  const auto obstacles = written();
  ASSERT_EQ(obstacles.size(), 2u);
  for (const Obstacle& obstacle : obstacles) {
    EXPECT_EQ(obstacle.kind, ObstacleKind::Barrier);
    EXPECT_EQ(obstacle.outline.size(), 2u);
  }
}

TEST_F(ObstaclesTest, TreesStandBesideTheRoadOnly) {
  builder_.node(1, 0, 10, {{"natural", "tree"}}).node(2, 0, 1, {{"natural", "tree"}});
  builder_.node(3, 5, 10, {{"barrier", "bollard"}});
  const auto obstacles = written();
  ASSERT_EQ(obstacles.size(), 2u);
  EXPECT_EQ(obstacles[0].kind, ObstacleKind::Furniture);
  EXPECT_EQ(counts_.at("left_out_on_lane"), 1);
}

// polyconvert's houses on guessed sidewalks: two people circled before them until the run ended
TEST(ClearLanes, CutsTheGroundOfLanesOutOfUsersPolygons) {
  RoadNetwork road = one_lane(vehicle_class::kPedestrian);
  const auto square = [](double x, double y, double half) {
    return std::vector<Vec2>{
        {x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
  };
  road.obstacles = {{ObstacleKind::Building, square(0, 0, 5)},
                    {ObstacleKind::Building, square(30, 10, 5)},
                    {ObstacleKind::Barrier, {{50, -5}, {50, 5}}},
                    {ObstacleKind::Furniture, square(60, 0.5, 0.2)}};
  const ClearedObstacles counts = clear_lanes(road);
  EXPECT_EQ(counts.cut, 2u);
  EXPECT_EQ(counts.left_out, 1u);
  ASSERT_EQ(road.obstacles.size(), 5u) << "two of a house, one whole, two of a wall";
  for (const Obstacle& obstacle : road.obstacles)
    for (const Vec2& corner : obstacle.outline) EXPECT_GE(std::abs(corner.y()), 0.79);
  EXPECT_EQ(road.obstacles[2].outline, square(30, 10, 5)) << "off the lanes nothing changes";
}

TEST_F(ObstaclesTest, SaysWhereItCannotWrite) {
  const GeoBox box = builder_.box(-500, -500, 500, 500);
  EXPECT_THROW(write_obstacles(builder_.map, projection_, one_lane(), box, "/no/such/folder/o.xml",
                               builder_.log),
               Error);
}

TEST(GeoProjection, IsMetricAboutItsMiddle) {
  const GeoProjection projection(local_projection({7.42, 43.73}));
  EXPECT_NEAR(projection.to_plane({7.42, 43.73}).norm(), 0, 1e-6);
  // one minute of arc north along the ellipsoid at this latitude: 1852 m within 0.1 %
  EXPECT_NEAR(projection.to_plane({7.42, 43.73 + 1.0 / 60}).y(), 1851.7, 1.0);
  EXPECT_NEAR(projection.to_plane({7.42, 43.73 + 1.0 / 60}).x(), 0, 1e-6);
  EXPECT_THROW(GeoProjection("+proj=nonsense"), Error);
}

}  // namespace
}  // namespace sumogamma::osm
