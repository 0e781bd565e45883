#include "osm/lanelet_network.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "osm/lanelet_graph.h"
#include "road/sumo_net_reader.h"
#include "support/lanelet_text.h"

namespace sumogamma::osm {
namespace {

namespace fs = std::filesystem;
using testing::LaneletPlaces;
using testing::LaneletText;

class LaneletNetwork : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("lanelets_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file(const std::string& text) const {
    std::ofstream(folder_ / "map.osm") << text;
    return folder_ / "map.osm";
  }
  LaneletMap read(const std::string& text) const { return read_lanelet_map(file(text)); }
  RoadNetwork network(const PlainNetwork& plain) const {
    write_lanelet_network(plain, folder_, "map");
    return read_sumo_net(folder_ / "map.net.xml");
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

const Lanelet& lanelet(const LaneletMap& map, std::int64_t id) {
  return *std::find_if(map.lanelets.begin(), map.lanelets.end(),
                       [&](const Lanelet& one) { return one.id == id; });
}

void expect_point(const Vec2& point, double x, double y) {
  EXPECT_NEAR(point.x(), x, 0.02);
  EXPECT_NEAR(point.y(), y, 0.02);
}

TEST_F(LaneletNetwork, ReadsBothFormsOfPlaces) {
  for (const LaneletPlaces places : {LaneletPlaces::AboutZero, LaneletPlaces::Local}) {
    const LaneletMap map = read(testing::lanelet_crossing(places));
    ASSERT_EQ(map.lanelets.size(), 11u);
    const Lanelet &west = lanelet(map, 1003), &south = lanelet(map, 1009);
    expect_point(west.center.points().front(), -60, 1.75);
    expect_point(west.center.points().back(), 0, 1.75);
    EXPECT_NEAR(west.width, 3.5, 0.01);
    EXPECT_NEAR(west.speed, 50 / 3.6, 1e-9);
    EXPECT_EQ(west.rule, LaneletRule::GoesFirst);
    expect_point(south.center.points().back(), 6.75, -10);
    EXPECT_NEAR(south.speed, 30 / 3.6, 1e-9);
    EXPECT_EQ(south.rule, LaneletRule::Yields);
    EXPECT_EQ(lanelet(map, 1013).use, LaneletUse::Foot);
    EXPECT_EQ(map.left_out.at("lanelets for people (crosswalk)"), 1);
    EXPECT_EQ(map.without_a_limit, 7u);
  }
}

TEST_F(LaneletNetwork, TurnsALaneletWhoseBordersRunAgainstIt) {
  LaneletText map;
  map.lanelet(map.way({{50, 3}, {0, 3}}), map.way({{50, 0}, {0, 0}}));
  const LaneletMap read_map = read(map.text());
  EXPECT_EQ(read_map.turned, 1u);
  expect_point(read_map.lanelets[0].center.points().back(), 50, 1.5);
}

TEST_F(LaneletNetwork, MakesEdgesLanesAndWaysOverTheJunction) {
  const LaneletMap map = read(testing::lanelet_crossing());
  const PlainNetwork plain = plain_network_of(map, 40.0, folder_ / "map.osm");
  EXPECT_EQ(plain.edge_count, 4u);
  EXPECT_EQ(plain.lane_count, 6u);
  EXPECT_EQ(plain.turn_count, 4u);
  EXPECT_EQ(plain.junction_count, 1u);
  EXPECT_EQ(plain.without_a_rule, 0u);
  EXPECT_EQ(plain.prolonged, 6u);
  const RoadNetwork road = network(plain);
  const Lane& west = road.lane(road.lane_by_name.at("L1003_0"));
  EXPECT_NEAR(west.centerline.points().front().x(), -100, 1.1);
  expect_point(west.centerline.points().back(), 0, 1.75);
  EXPECT_NEAR(west.width, 3.5, 0.01);
  // the right turn is driven as it is drawn, and gives way
  const Lane& south = road.lane(road.lane_by_name.at("L1009_0"));
  ASSERT_EQ(south.outgoing.size(), 2u);
  for (const ConnectionId id : south.outgoing) {
    const Connection& turn = road.connection(id);
    EXPECT_EQ(turn.priority, LinkPriority::Minor);
    if (road.edge(road.lane(turn.to).edge).name != "L1007") continue;
    const Polyline& way = road.lane(turn.via).centerline;
    EXPECT_LT(way.project({11, 0.5}).distance, 0.6);
  }
  EXPECT_EQ(road.connection(west.outgoing.at(0)).priority, LinkPriority::Major);
}

TEST_F(LaneletNetwork, CutsALaneInWhoseMiddleAnotherEnds) {
  //  ============  two lanes; a slip road joins the right one at x = 60
  //       ____/
  LaneletText text;
  const int right = text.way({{0, 0}, {120, 0}}), middle = text.way({{0, 3}, {120, 3}}),
            left = text.way({{0, 6}, {120, 6}});
  text.lanelet(middle, right);
  text.lanelet(left, middle);
  text.lanelet(text.way({{0, -10}, {40, -10}, {60, 2.9}}),
               text.way({{0, -13}, {42, -13}, {62, 0.1}}));
  const LaneletMap map = read(text.text());
  const LaneletGraph graph = lanelet_graph_of(map, 0.0);
  EXPECT_GE(graph.cut, 2u);
  // before the merge the lanes are lanes, in one row
  const auto is_approach = [](const Lanelet& one) {
    return one.center.points().front().x() < 1 && std::abs(one.center.points().front().y()) < 5 &&
           one.center.length() > 25 && one.center.length() < 60;
  };
  EXPECT_EQ(std::count_if(graph.lanelets.begin(), graph.lanelets.end(), is_approach), 2);
  const PlainNetwork plain = plain_network_of(map, 0.0, folder_ / "map.osm");
  // the slip road and the piece of the lane before it lie on the junction, and what is beside them
  EXPECT_EQ(plain.junction_count, 1u) << plain.edges;
  const RoadNetwork road = network(plain);
  std::size_t in = 0;
  for (const Connection& link : road.connections)
    in += road.lane(link.from).kind == LaneKind::Normal;
  EXPECT_EQ(in, plain.turn_count);
  EXPECT_GE(plain.turn_count, 3u);
}

TEST_F(LaneletNetwork, ProlongsTwoLaneletsThatBeginAtOnePlaceByOneLane) {
  LaneletText text;
  text.lanelet(text.way({{0, 3}, {30, 3}}), text.way({{0, 0}, {30, 0}}));
  text.lanelet(text.way({{0, 3.1}, {20, 2}, {30, -10}}),
               text.way({{0, -0.1}, {17, -1}, {26, -12}}));
  const PlainNetwork plain = plain_network_of(read(text.text()), 50.0, folder_ / "map.osm");
  EXPECT_EQ(plain.edge_count, 3u) << plain.edges;
  EXPECT_EQ(plain.turn_count, 2u);
  EXPECT_FALSE(network(plain).connections.empty());
}

TEST_F(LaneletNetwork, RefusesWhatIsNoMapOfLanelets) {
  EXPECT_NE(refusal("no XML").find("map.osm"), std::string::npos);
  EXPECT_NE(refusal("<osm version='0.6'/>").find("has no nodes"), std::string::npos);
  EXPECT_NE(refusal("<osm><node id='1' lat='0' lon='0'/></osm>").find("no lanelets for vehicles"),
            std::string::npos);
  EXPECT_NE(refusal("<osm><node id='1' lat='49' lon='8'/></osm>").find("--origin LAT,LON"),
            std::string::npos);
  LaneletText text;
  text.lanelet(text.way({{0, 3}, {50, 3}}), 7);
  EXPECT_NE(refusal(text.text()).find("lanelet 1001 lacks its way 7"), std::string::npos);
  LaneletText thin;
  thin.lanelet(thin.way({{0, 0.2}, {50, 0.2}}), thin.way({{0, 0}, {50, 0}}));
  EXPECT_NE(refusal(thin.text()).find("0.20 m wide"), std::string::npos);
}

/// A signalled junction of SinD's, as its owners draw it.
TEST_F(LaneletNetwork, MakesARoadNetworkOfARealMap) {
  const fs::path map =
      fs::path(SUMOGAMMA_SHARED_DIR) / "data" / "trajectories" / "sind" / "tianjin.lanelet2.osm";
  if (!fs::exists(map)) GTEST_SKIP() << "no map beside the project: " << map;
  const LaneletMap lanelets = read_lanelet_map(map);
  EXPECT_EQ(lanelets.lanelets.size(), 66u);
  const PlainNetwork plain = plain_network_of(lanelets, 50.0, map);
  EXPECT_EQ(plain.junction_count, 1u);
  const RoadNetwork road = network(plain);
  EXPECT_EQ(plain.lane_count, 20u);
}

}  // namespace
}  // namespace sumogamma::osm
