#include "osm/repairs/walking_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "osm/lane_clearing.h"
#include "osm/network_file.h"
#include "road/conflict_zones.h"
#include "road/lane_locator.h"
#include "support/plain_net.h"

namespace sumogamma::osm {
namespace {

namespace fs = std::filesystem;
using sumogamma::testing::crossroads;
using sumogamma::testing::PlainNet;
using sumogamma::testing::read_plain_net;
using sumogamma::testing::write_plain_net;

/// Crossroads with sidewalks whose kerbs have hardly a radius at the corners.
PlainNet sharp_corners() {
  return crossroads("priority", {"--sidewalks.guess", "--sidewalks.guess.max-speed", "20",
                                 "--walkingareas", "--default.junctions.radius", "0.3"});
}

using Outlines = std::map<std::string, std::vector<Vec2>>;

bool on_area(const RoadNetwork& road, const Outlines& outlines, const Vec2& point) {
  return std::any_of(road.lanes.begin(), road.lanes.end(), [&](const Lane& lane) {
    if (lane.kind != LaneKind::WalkingArea) return false;
    const auto cut = outlines.find(lane.name);
    return ring_contains(cut == outlines.end() ? lane.outline : cut->second, point);
  });
}

/// Metres over the junctions on which a car's side, as it turns, is over a walking area and over no
/// lane of cars; areas as in `outlines`, or else as they are.
double on_walkways(const RoadNetwork& road, const Outlines& outlines) {
  constexpr double kPace = 0.1, kSide = 0.9;  // [m]
  double sum = 0;
  const LaneLocator locator(road);
  std::vector<LaneHit> hits;
  for (const Junction& junction : road.junctions) {
    for (const ConnectionId id : driven_links(road, junction)) {
      const Polyline line = rounded_way(road, id, 5.0, 5.0, {4.4}).line;
      for (double along = 0; along < line.length(); along += kPace) {
        for (const double side : {-kSide, kSide}) {
          const Vec2 point = line.point_at(along) + side * left_of(line.direction_at(along));
          locator.find_containing(point, hits);
          const bool on_lane = std::any_of(hits.begin(), hits.end(), [&](const LaneHit& hit) {
            return (road.lane(hit.lane).allowed & vehicle_class::kPassenger) != 0;
          });
          if (!on_lane && on_area(road, outlines, point)) sum += kPace;
        }
      }
    }
  }
  return sum;
}

TEST(WalkingGround, LessIsLeftWhereVehiclesTurn) {
  const RoadNetwork road = read_plain_net(sharp_corners());
  const double before = on_walkways(road, {});
  EXPECT_GT(before, 1.0) << "else this shows nothing";
  const Outlines outlines = walking_areas_off_the_road(road);
  EXPECT_FALSE(outlines.empty());
  EXPECT_LT(on_walkways(road, outlines), 0.75 * before);
}

// cut back to the kerb alone, one corner left so little that a crowd stood before it for minutes
TEST(WalkingGround, TheWaysOfPeopleStay) {
  const RoadNetwork road = read_plain_net(sharp_corners());
  for (const auto& [name, outline] : walking_areas_off_the_road(road)) {
    const Lane& area = road.lane(road.lane_by_name.at(name));
    const std::vector<WalkingEnd> ends = walking_ends(road, area);
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (std::size_t k = i + 1; k < ends.size(); ++k) {
        const Vec2 way = ends[k].place - ends[i].place;
        if (way.norm() < 1.0) continue;
        const double half_width = 0.5 * std::min(ends[i].width, ends[k].width);
        for (const double aside : {-0.9, 0.0, 0.9}) {
          const Vec2 place =
              ends[i].place + 0.5 * way + aside * half_width * left_of(way.normalized());
          EXPECT_TRUE(ring_contains(outline, place) || !ring_contains(area.outline, place)) << name;
        }
      }
  }
}

TEST(WalkingGround, EveryLaneOnFootStillEndsAtItsArea) {
  const RoadNetwork road = read_plain_net(sharp_corners());
  for (const auto& [name, outline] : walking_areas_off_the_road(road)) {
    const Lane& area = road.lane(road.lane_by_name.at(name));
    for (const ConnectionId id : area.incoming) {
      const Vec2 end = road.lane(road.connection(id).from).centerline.points().back();
      if (distance_to_ring(area.outline, end) > 0.1) continue;
      EXPECT_LT(distance_to_ring(outline, end), 0.4) << name;
    }
  }
}

TEST(WalkingGround, AreasBesideWideCornersStay) {
  PlainNet wide = sharp_corners();
  wide.options.back() = "12";
  EXPECT_TRUE(walking_areas_off_the_road(read_plain_net(wide)).empty());
}

class WalkingGroundFile : public ::testing::Test {
 protected:
  ~WalkingGroundFile() override { fs::remove(file_); }
  fs::path file_ =
      fs::temp_directory_path() / ("sumogamma_ground_" + std::to_string(getpid()) + ".net.xml");
};

TEST_F(WalkingGroundFile, OutlinesAreWrittenAndNothingElseChanges) {
  write_plain_net(sharp_corners(), file_);
  const NetworkFile network = load_network(file_);
  const RoadNetwork& before = network.road;
  const Outlines outlines = walking_areas_off_the_road(before);
  set_walking_areas(network.net(), before, outlines);
  const RoadNetwork after = read_sumo_net(network.document, file_);
  ASSERT_EQ(after.lanes.size(), before.lanes.size());
  for (std::size_t i = 0; i < after.lanes.size(); ++i) {
    const auto cut = outlines.find(after.lanes[i].name);
    if (cut == outlines.end()) {
      EXPECT_EQ(after.lanes[i].centerline.points(), before.lanes[i].centerline.points());
      continue;
    }
    for (const Vec2& point : cut->second)
      EXPECT_LT(distance_to_ring(after.lanes[i].outline, point), 0.02) << cut->first;
  }
}

TEST_F(WalkingGroundFile, HeightsGoWithTheNearestPoint) {
  PlainNet hill = sharp_corners();
  const std::string flat = "y=\"0\"";
  for (std::size_t at = hill.nodes.find(flat); at != std::string::npos;
       at = hill.nodes.find(flat, at + 1))
    hill.nodes.replace(at, flat.size(), "y=\"0\" z=\"7\"");
  write_plain_net(hill, file_);
  const NetworkFile network = load_network(file_);
  const RoadNetwork& before = network.road;
  const Outlines outlines = walking_areas_off_the_road(before);
  ASSERT_FALSE(outlines.empty());
  set_walking_areas(network.net(), before, outlines);
  const RoadNetwork after = read_sumo_net(network.document, file_);
  for (const auto& [name, outline] : outlines) {
    const Lane& area = after.lane(after.lane_by_name.at(name));
    ASSERT_EQ(area.elevation.size(), area.outline.size()) << name;
    for (const double height : area.elevation) EXPECT_NEAR(height, 7.0, 0.5) << name;
  }
}

}  // namespace
}  // namespace sumogamma::osm
