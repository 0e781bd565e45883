#include "osm/repairs/carriageways_apart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/units.h"
#include "osm/lane_overlap.h"
#include "osm/netconvert.h"
#include "support/plain_net.h"

namespace sumogamma::osm {
namespace {

namespace fs = std::filesystem;
using sumogamma::testing::PlainNet;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::UnorderedElementsAre;

std::string node(const std::string& id, double x, double y, double z = 0) {
  return "<node id='" + id + "' x='" + std::to_string(x) + "' y='" + std::to_string(y) + "' z='" +
         std::to_string(z) + "'/>";
}

std::string edge(const std::string& from, const std::string& to, int lanes,
                 const std::string& more = "spreadType='center'") {
  return "<edge id='" + from + to + "' from='" + from + "' to='" + to + "' numLanes='" +
         std::to_string(lanes) + "' speed='13.9' " + more + "/>";
}

/// A road of two lanes from A to B, eastwards along the axis, and one from C to D beside it.
PlainNet two_roads(double gap, double height = 0) {
  return {
      node("A", 0, 0) + node("B", 200, 0) + node("C", 0, gap, height) + node("D", 200, gap, height),
      edge("A", "B", 2) + edge("C", "D", 2),
      "",
      {}};
}

class CarriagewaysApart : public ::testing::Test {
 protected:
  CarriagewaysApart() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    request_.folder =
        fs::temp_directory_path() / ("apart_" + std::to_string(getpid()) + "_" + info->name());
    fs::remove_all(request_.folder);
    fs::create_directories(request_.folder / "work");
  }
  ~CarriagewaysApart() override { fs::remove_all(request_.folder); }

  fs::path network() const { return request_.folder / request_.network; }
  NetworkFile built(const PlainNet& plain) const {
    sumogamma::testing::write_plain_net(plain, network());
    return load_network(network());
  }
  RoadNetwork build(const PlainNet& plain) const { return built(plain).road; }
  /// What netconvert makes of the plan.
  RoadNetwork patched(const CarriagewayPlan& plan) const {
    NetworkPatch patch;
    patch.carriageways = plan;
    patch_network(request_, load_network(network()).net(), patch);
    return read_sumo_net(network());
  }
  NetconvertRequest request_;
};

OverlapLength overlap(const RoadNetwork& road) {
  return overlap_length(road, find_lane_overlaps(road));
}

const Lane& lane(const RoadNetwork& road, const std::string& name) {
  return road.lane(road.lane_by_name.at(name));
}

TEST(LaneOverlap, MeasuresWhatLiesOnLanesOfOtherEdges) {
  // lanes of 3.2 m: A-B takes -3.2 to 3.2, C-D 0.8 to 7.2: the inner lane of each, all along
  const RoadNetwork road = sumogamma::testing::read_plain_net(two_roads(4.0));
  const auto overlaps = find_lane_overlaps(road);
  ASSERT_EQ(overlaps.size(), 2u);
  EXPECT_EQ(road.lane(overlaps[0].lane).name, "AB_1");
  EXPECT_EQ(road.lane(overlaps[0].other).name, "CD_0");
  EXPECT_NEAR(overlaps[0].depth, 2.4, 0.02);
  EXPECT_NEAR(overlap_length(road, overlaps).wheels, 400, 2);
  EXPECT_NEAR(overlap_length(road, overlaps).all_wheels, 800, 2);
  EXPECT_EQ(overlap_length(road, overlaps).walking, 0);
}

TEST(LaneOverlap, LeavesOutWhatIsApart) {
  // beside each other, above each other, and across each other
  for (const PlainNet& apart :
       {two_roads(6.4), two_roads(4.0, 5.0),
        PlainNet{node("A", 0, 0) + node("B", 200, 0) + node("C", 100, -50) + node("D", 100, 50),
                 edge("A", "B", 2) + edge("C", "D", 2),
                 "",
                 {}}})
    EXPECT_THAT(find_lane_overlaps(sumogamma::testing::read_plain_net(apart)), IsEmpty());
}

TEST(LaneOverlap, CountsWalkingOnDrivingApart) {
  PlainNet plain = two_roads(4.0);
  plain.edges = edge("A", "B", 2) + edge("C", "D", 1, "allow='pedestrian' width='2'");
  // the footway takes 2 to 4, the outer lane of A-B 0 to 3.2
  const OverlapLength length = overlap(sumogamma::testing::read_plain_net(plain));
  EXPECT_EQ(length.wheels, 0);
  EXPECT_NEAR(length.walking, 200, 2);
}

TEST_F(CarriagewaysApart, MovesBothByHalfOfTheOverlap) {
  const RoadNetwork before = build(two_roads(4.0));
  const CarriagewayPlan plan = plan_carriageways(load_network(network()));
  EXPECT_THAT(plan.shapes, UnorderedElementsAre(Key("AB"), Key("CD")));
  EXPECT_THAT(plan.lane_widths, IsEmpty());
  EXPECT_THAT(plan.dropped, IsEmpty());
  const RoadNetwork after = patched(plan);
  EXPECT_EQ(overlap(after).wheels, 0);
  const double down = lane(before, "AB_0").centerline.point_at(100).y() -
                      lane(after, "AB_0").centerline.point_at(100).y();
  const double up = lane(after, "CD_0").centerline.point_at(100).y() -
                    lane(before, "CD_0").centerline.point_at(100).y();
  EXPECT_NEAR(down, up, 0.02);
  EXPECT_GE(down, 1.2);
  EXPECT_LE(down, 1.4);
}

TEST_F(CarriagewaysApart, LeavesWhatIsApartAsItIs) {
  EXPECT_TRUE(plan_carriageways(built(two_roads(6.5))).empty());
  EXPECT_TRUE(plan_carriageways(built(two_roads(4.0, 5.0))).empty());
}

TEST_F(CarriagewaysApart, KeepsTheTwoDirectionsOfARoadTogether) {
  // B-A lies north of A-B, and C-D on B-A
  PlainNet plain = two_roads(5.0);
  plain.edges = edge("A", "B", 1, "") + edge("B", "A", 1, "") + edge("C", "D", 2);
  const RoadNetwork before = build(plain);
  ASSERT_GT(overlap(before).wheels, 300);
  const RoadNetwork after = patched(plan_carriageways(load_network(network())));
  EXPECT_EQ(overlap(after).wheels, 0);
  EXPECT_NEAR(lane(after, "BA_0").centerline.point_at(100).y() -
                  lane(after, "AB_0").centerline.point_at(100).y(),
              3.2, 0.05);
}

/// A road of two directions that turns to the left with a radius of 15 m.
PlainNet bent_road(bool left_hand) {
  std::string there, back;
  auto add = [&](double x, double y) {
    const std::string point = std::to_string(x) + "," + std::to_string(y);
    there += (there.empty() ? "" : " ") + point;
    back = point + (back.empty() ? "" : " ") + back;
  };
  add(-80, -15);
  for (int k = 0; k <= 9; ++k) add(15 * std::sin(k * kPi / 18), -15 * std::cos(k * kPi / 18));
  add(15, 80);
  return {node("A", -80, -15) + node("B", 15, 80),
          edge("A", "B", 1, "shape='" + there + "'") + edge("B", "A", 1, "shape='" + back + "'"),
          "", left_hand ? std::vector<std::string>{"--lefthand"} : std::vector<std::string>{}};
}

TEST_F(CarriagewaysApart, LeavesRoomBetweenTheDirectionsOfASharpBend) {
  for (const bool left_hand : {false, true}) {
    SCOPED_TRACE(left_hand);
    request_.left_hand = left_hand;
    const RoadNetwork before = build(bent_road(left_hand));
    const CarriagewayPlan plan = plan_carriageways(load_network(network()));
    EXPECT_THAT(plan.bends, UnorderedElementsAre(left_hand ? "BA" : "AB"));
    EXPECT_THAT(plan.apart, IsEmpty());
    const RoadNetwork after = patched(plan);
    const char* outer = left_hand ? "BA_0" : "AB_0";
    const char* inner = left_hand ? "AB_0" : "BA_0";
    const Vec2 middle(15 * std::sin(kPi / 4), -15 * std::cos(kPi / 4));
    const auto from_middle = [&](const RoadNetwork& road, const char* name) {
      return lane(road, name).centerline.project(middle).distance;
    };
    EXPECT_NEAR(from_middle(before, outer), 1.6, 0.1);
    // a bus's nose needs 2.2 m; SUMO's points of the arc lie metres apart
    EXPECT_NEAR(from_middle(after, outer) - from_middle(before, outer), 2.0, 0.3);
    EXPECT_NEAR(from_middle(after, inner), from_middle(before, inner), 0.05);
    for (const Vec2& end : {Vec2(-78, -15), Vec2(15, 78)})
      EXPECT_NEAR(lane(after, "AB_0").centerline.project(end).distance, 1.6, 0.1);
  }
}

TEST_F(CarriagewaysApart, FadesOutAlongTheRoadAndOverItsJunctions) {
  // C-D comes within 4 m of A-B towards their ends only; A-B goes on as B-E
  //
  //   C---___                     the move that D needs at B has faded out 40 m farther east,
  //          ---___D              and lanes meet at B
  //   A------------B-----E
  const PlainNet plain = {node("A", 0, 0) + node("B", 200, 0) + node("E", 400, 0) +
                              node("C", 0, 16) + node("D", 200, 4),
                          edge("A", "B", 2) + edge("B", "E", 2) + edge("C", "D", 2),
                          "",
                          {}};
  const RoadNetwork before = build(plain);
  ASSERT_GT(overlap(before).wheels, 20);
  const CarriagewayPlan plan = plan_carriageways(load_network(network()));
  EXPECT_THAT(plan.shapes, UnorderedElementsAre(Key("AB"), Key("BE"), Key("CD")));
  const RoadNetwork after = patched(plan);
  EXPECT_EQ(overlap(after).wheels, 0);
  const auto& in = lane(after, "AB_0").centerline;
  const auto& out = lane(after, "BE_0").centerline;
  EXPECT_LT(in.points().back().y(), -2.1);  // from -1.6
  EXPECT_NEAR(in.points().back().y(), out.points().front().y(), 0.3);
  EXPECT_NEAR(in.points().front().y(), -1.6, 0.02);
  EXPECT_NEAR(out.points().back().y(), -1.6, 0.02);
  for (double along = 5; along < in.length(); along += 5)
    EXPECT_LT(std::abs(in.point_at(along).y() - in.point_at(along - 5).y()), 0.6) << along;
}

TEST_F(CarriagewaysApart, NarrowsLanesWhereThereIsNoRoom) {
  // five roads of two lanes, 3.8 m apart: 6.4 m each cannot fit by moves of 4 m
  PlainNet plain;
  for (int i = 0; i < 5; ++i) {
    const std::string from = "A" + std::to_string(i), to = "B" + std::to_string(i);
    plain.nodes += node(from, 0, 3.8 * i) + node(to, 200, 3.8 * i);
    plain.edges += edge(from, to, 2);
  }
  const RoadNetwork before = build(plain);
  const CarriagewayPlan plan = plan_carriageways(load_network(network()));
  ASSERT_FALSE(plan.lane_widths.empty());
  for (const auto& [name, width] : plan.lane_widths) EXPECT_EQ(width, 2.75) << name;
  EXPECT_LE(plan.farthest, 4.0);
  const RoadNetwork after = patched(plan);
  EXPECT_EQ(lane(after, plan.lane_widths.begin()->first).width, 2.75);
  EXPECT_LT(overlap(after).wheels, overlap(before).wheels / 4);
  EXPECT_EQ(after.connections.size(), before.connections.size());
}

/// A road of `lanes` lanes each way and a path on its line, between the same two places as a
/// footway in a wide arc, if `with_footway`.
PlainNet path_on_road(int lanes, bool with_footway) {
  return {node("A", 0, 0) + node("B", 200, 0) + node("C", -10, 0) + node("D", 210, 0) +
              node("X", -30, 0) + node("Y", 230, 0),
          edge("A", "B", lanes, "disallow='pedestrian'") +
              edge("B", "A", lanes, "disallow='pedestrian'") +
              edge("C", "D", 1, "allow='pedestrian bicycle' width='2'") +
              edge("X", "C", 1, "allow='pedestrian' width='2'") +
              edge("D", "Y", 1, "allow='pedestrian' width='2'") +
              (with_footway ? edge("C", "D", 1,
                                   "allow='pedestrian' width='2' shape='-10,0 -10,90 210,90 210,0'")
                                  .replace(10, 2, "arc")
                            : std::string()),
          "",
          {}};
}

TEST_F(CarriagewaysApart, APathMakesWayForARoad) {
  const RoadNetwork before = build(path_on_road(1, false));
  ASSERT_GT(overlap(before).wheels, 150);
  const CarriagewayPlan plan = plan_carriageways(load_network(network()));
  EXPECT_THAT(plan.dropped, IsEmpty());
  EXPECT_TRUE(plan.shapes.contains("CD"));
  EXPECT_FALSE(plan.shapes.contains("AB"));
  EXPECT_EQ(overlap(patched(plan)).wheels, 0);
}

TEST_F(CarriagewaysApart, DropsAPathInAWideRoad) {
  const RoadNetwork before = build(path_on_road(4, true));
  const CarriagewayPlan plan = plan_carriageways(load_network(network()));
  EXPECT_THAT(plan.dropped, UnorderedElementsAre("CD"));
  const RoadNetwork after = patched(plan);
  EXPECT_FALSE(after.edge_by_name.contains("CD"));
  EXPECT_TRUE(after.edge_by_name.contains("AB"));
  EXPECT_EQ(overlap(after).wheels, 0);
}

TEST_F(CarriagewaysApart, KeepsAPathWithoutWhichNobodyGetsThere) {
  EXPECT_THAT(plan_carriageways(built(path_on_road(4, false))).dropped, IsEmpty());
}

TEST_F(CarriagewaysApart, NamesAFileThatIsNoNetwork) {
  const RoadNetwork road = build(two_roads(4.0));
  std::ofstream(network()) << "hello";
  EXPECT_ANY_THROW(load_network(network()));
}

}  // namespace
}  // namespace sumogamma::osm
