#include "road/sumo_net_reader.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

// A west-east road W->C->E with a signal at C and a crossing south of it:
//
//   W ==in==> C ==out==> E        in: lane 0 is a sidewalk, lane 1 for cars
constexpr const char* kNet = R"xml(<?xml version="1.0" encoding="UTF-8"?>
<net version="1.9" lefthand="true">
  <location netOffset="10.00,-5.00" convBoundary="0,0,200,0" origBoundary="0,0,1,1" projParameter="+proj=tmerc"/>
  <edge id=":C_0" function="internal">
    <lane id=":C_0_0" index="0" disallow="pedestrian tram" speed="13.9" length="10" shape="95,0 105,0"/>
  </edge>
  <edge id=":C_c0" function="crossing" crossingEdges="out">
    <lane id=":C_c0_0" index="0" allow="pedestrian" speed="1" length="6.4" width="4" shape="103,-3 103,3"/>
  </edge>
  <edge id=":C_w0" function="walkingarea">
    <lane id=":C_w0_0" index="0" allow="pedestrian" speed="1" length="2" width="2" shape="100,-5 106,-5 106,-3 100,-3"/>
  </edge>
  <edge id="in" from="W" to="C" priority="7" type="highway.primary">
    <lane id="in_0" index="0" allow="pedestrian" speed="1.5" length="95" width="2" shape="0,2 95,2"/>
    <lane id="in_1" index="1" disallow="pedestrian" speed="13.9" length="96" shape="0,0,0 50,0,5 50,0,5 95,0,5"/>
  </edge>
  <edge id="out" from="C" to="E" priority="7">
    <lane id="out_0" index="0" speed="13.9" length="95" shape="105,0 200,0"><neigh lane="in_1"/></lane>
  </edge>
  <tlLogic id="C" type="static" programID="0" offset="0"><phase duration="30" state="Gr"/></tlLogic>
  <junction id="W" type="dead_end" x="0" y="0" incLanes="" intLanes="" shape="0,0 0,1"/>
  <junction id="C" type="traffic_light" x="100" y="0" incLanes="in_1 :C_w0_0" intLanes=":C_0_0 :C_c0_0" shape="95,-2 105,-2 105,2">
    <request index="0" response="10" foes="10" cont="1"/>
    <request index="1" response="00" foes="01" cont="0"/>
  </junction>
  <junction id="E" type="dead_end" x="200" y="0" incLanes="out_0" intLanes="" shape="200,0 200,1"/>
  <connection from="in" to="out" fromLane="1" toLane="0" via=":C_0_0" tl="C" linkIndex="0" dir="s" state="o"/>
  <connection from=":C_0" to="out" fromLane="0" toLane="0" dir="s" state="M"/>
  <connection from=":C_w0" to=":C_c0" fromLane="0" toLane="0" tl="C" linkIndex="1" dir="s" state="o"/>
  <connection from="in" to=":C_w0" fromLane="0" toLane="0" dir="s" state="M"/>
  <roundabout nodes="C E" edges="out"/>
</net>
)xml";

class SumoNetReader : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("sumogamma_net_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  static std::string with(const std::string& old_text, const std::string& new_text) {
    std::string net = kNet;
    const std::size_t at = net.find(old_text);
    EXPECT_NE(at, std::string::npos) << old_text;
    return net.replace(at, old_text.size(), new_text);
  }
  /// What the reader says about a network; empty where it accepts it.
  std::string complaint(const std::string& content) const {
    try {
      read_sumo_net(write("bad.net.xml", content));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(SumoNetReader, ReadsLanesOfEveryKind) {
  const RoadNetwork net = read_sumo_net(write("a.net.xml", kNet));
  EXPECT_TRUE(net.left_hand);
  EXPECT_EQ(net.projection, "+proj=tmerc");
  EXPECT_EQ(net.projection_offset, Vec2(10, -5));
  ASSERT_EQ(net.lanes.size(), 6u);
  const Lane& sidewalk = net.lane(net.lane_by_name.at("in_0"));
  const Lane& road = net.lane(net.lane_by_name.at("in_1"));
  EXPECT_EQ(sidewalk.allowed, vehicle_class::kPedestrian);
  EXPECT_EQ(sidewalk.inner, net.lane_by_name.at("in_1"));
  EXPECT_EQ(road.outer, net.lane_by_name.at("in_0"));
  EXPECT_EQ(road.inner, kNoLane);
  EXPECT_DOUBLE_EQ(road.width, 3.2);
  EXPECT_DOUBLE_EQ(road.length, 96);
  EXPECT_DOUBLE_EQ(road.centerline.length(), 95);
  EXPECT_FALSE(road.allowed & vehicle_class::kPedestrian);
  EXPECT_TRUE(road.allowed & vehicle_class::kPassenger);
  EXPECT_EQ(net.lane(net.lane_by_name.at("out_0")).opposite, net.lane_by_name.at("in_1"));
  const Lane& inside = net.lane(net.lane_by_name.at(":C_0_0"));
  EXPECT_EQ(inside.kind, LaneKind::Internal);
  EXPECT_EQ(inside.junction, net.junction_by_name.at("C"));
  EXPECT_FALSE(inside.allowed & (vehicle_class::kPedestrian | vehicle_class::kTram));
  EXPECT_EQ(net.lane(net.lane_by_name.at(":C_w0_0")).outline.size(), 4u);
  const Edge& crossing = net.edge(net.edge_by_name.at(":C_c0"));
  EXPECT_EQ(crossing.kind, LaneKind::Crossing);
  ASSERT_EQ(crossing.crossing_edges.size(), 1u);
  EXPECT_EQ(crossing.crossing_edges[0], net.edge_by_name.at("out"));
  EXPECT_EQ(net.edge(net.edge_by_name.at("in")).type, "highway.primary");
}

TEST_F(SumoNetReader, InterpolatesElevationAcrossARepeatedPoint) {
  const RoadNetwork net = read_sumo_net(write("a.net.xml", kNet));
  const Lane& road = net.lane(net.lane_by_name.at("in_1"));
  EXPECT_DOUBLE_EQ(elevation_at(road, 25), 2.5);
  EXPECT_DOUBLE_EQ(elevation_at(road, 80), 5.0);
  EXPECT_DOUBLE_EQ(elevation_at(net.lane(net.lane_by_name.at("out_0")), 80), 0.0);
}

TEST_F(SumoNetReader, NumbersLinksAsSumoDoes) {
  const RoadNetwork net = read_sumo_net(write("a.net.xml", kNet));
  const Junction& junction = net.junction(net.junction_by_name.at("C"));
  ASSERT_EQ(junction.requests.size(), 2u);
  EXPECT_TRUE(junction.in_roundabout);
  // response "10": link 0 yields to link 1, the crossing
  EXPECT_EQ(junction.requests[0].yields_to, (std::vector<bool>{false, true}));
  EXPECT_EQ(junction.requests[1].conflicts, (std::vector<bool>{true, false}));
  EXPECT_TRUE(junction.requests[0].may_stop_inside);
  const Connection& drive = net.connection(junction.links[0]);
  const Connection& walk = net.connection(junction.links[1]);
  EXPECT_EQ(drive.from, net.lane_by_name.at("in_1"));
  EXPECT_EQ(drive.via, net.lane_by_name.at(":C_0_0"));
  EXPECT_EQ(walk.to, net.lane_by_name.at(":C_c0_0"));
  EXPECT_EQ(walk.junction_link, 1);
  EXPECT_EQ(walk.signal_link, 1);
  const Signal& signal = net.signals.at(index_of(walk.signal));
  EXPECT_EQ(signal.size, 2u);
  ASSERT_EQ(signal.phases.size(), 1u);
  EXPECT_EQ(signal.phases[0].duration, 30.0);
  EXPECT_EQ(signal.phases[0].state, "Gr");
  // the sidewalk's link onto the walking area has no right of way
  EXPECT_EQ(net.connection(net.lane(net.lane_by_name.at("in_0")).outgoing.at(0)).junction_link, -1);
}

// A main road W - C - E and a side road S with a stop sign; the state of the link from the east to
// the south is netconvert's.
constexpr const char* kStopNet = R"xml(<net version="1.9">
  <edge id="west" from="W" to="C"><lane id="west_0" index="0" speed="13" length="90" shape="0,-2 90,-2"/></edge>
  <edge id="east" from="E" to="C"><lane id="east_0" index="0" speed="13" length="90" shape="200,2 110,2"/></edge>
  <edge id=":C_w0" function="walkingarea">
    <lane id=":C_w0_0" index="0" allow="pedestrian" speed="1" length="2" width="2" shape="103,-10 105,-10 105,-8 103,-8"/>
  </edge>
  <edge id="south" from="S" to="C">
    <lane id="south_0" index="0" allow="pedestrian" speed="1" length="90" shape="104,-100 104,-10"/>
    <lane id="south_1" index="1" speed="13" length="90" shape="102,-100 102,-10"/>
  </edge>
  <edge id="to_east" from="C" to="E"><lane id="to_east_0" index="0" speed="13" length="90" shape="110,-2 200,-2"/></edge>
  <edge id="to_west" from="C" to="W"><lane id="to_west_0" index="0" speed="13" length="90" shape="90,2 0,2"/></edge>
  <edge id="to_south" from="C" to="S"><lane id="to_south_0" index="0" speed="13" length="90" shape="98,-10 98,-100"/></edge>
  <junction id="W" type="dead_end" x="0" y="0" incLanes="to_west_0" intLanes="" shape="0,0 0,1"/>
  <junction id="E" type="dead_end" x="200" y="0" incLanes="to_east_0" intLanes="" shape="200,0 200,1"/>
  <junction id="S" type="dead_end" x="100" y="-100" incLanes="to_south_0" intLanes="" shape="100,-100 101,-100"/>
  <junction id="C" type="priority_stop" x="100" y="0" incLanes="west_0 east_0 south_0" intLanes="" shape="90,-10 110,-10 110,5"/>
  <connection from="west" to="to_east" fromLane="0" toLane="0" dir="s" state="M"/>
  <connection from="west" to="to_south" fromLane="0" toLane="0" dir="r" state="M"/>
  <connection from="east" to="to_west" fromLane="0" toLane="0" dir="s" state="M"/>
  <connection from="east" to="to_south" fromLane="0" toLane="0" dir="l" state="s"/>
  <connection from="south" to="to_east" fromLane="1" toLane="0" dir="r" state="s"/>
  <connection from="south" to="to_west" fromLane="1" toLane="0" dir="l" state="s"/>
  <connection from="south" to=":C_w0" fromLane="0" toLane="0" dir="s" state="M"/>
</net>
)xml";

TEST_F(SumoNetReader, AStopSignStandsOnAnApproachNotOnWhoTurnsOffTheMainRoad) {
  const RoadNetwork net = read_sumo_net(write("stop.net.xml", kStopNet));
  const auto priorities = [&](const char* lane) {
    std::vector<LinkPriority> found;
    for (const ConnectionId id : net.lane(net.lane_by_name.at(lane)).outgoing)
      found.push_back(net.connection(id).priority);
    return found;
  };
  EXPECT_EQ(priorities("east_0"), (std::vector{LinkPriority::Major, LinkPriority::Minor}));
  EXPECT_EQ(priorities("south_1"), (std::vector{LinkPriority::Stop, LinkPriority::Stop}));
  EXPECT_EQ(priorities("west_0"), (std::vector{LinkPriority::Major, LinkPriority::Major}));
}

TEST_F(SumoNetReader, ReadsGzip) {
  const fs::path file = folder_ / "a.net.xml.gz";
  gzFile stream = gzopen(file.c_str(), "wb");
  gzputs(stream, kNet);
  gzclose(stream);
  EXPECT_EQ(read_sumo_net(file).lanes.size(), 6u);
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_THROW(read_sumo_net(file), Error);
}

TEST_F(SumoNetReader, NamesTheFileAndTheFault) {
  EXPECT_THROW(read_sumo_net(folder_ / "absent.net.xml"), Error);
  EXPECT_THROW(read_sumo_net(folder_), Error);
  EXPECT_NE(complaint("").find("bad.net.xml"), std::string::npos);
  EXPECT_NE(complaint("<routes/>").find("<routes>"), std::string::npos);
  EXPECT_NE(complaint("<net><edge").find("not well-formed"), std::string::npos);
  EXPECT_NE(complaint("<net/>").find("no lane"), std::string::npos);
  EXPECT_NE(complaint(with("from=\"W\"", "from=\"Q\"")).find("'Q'"), std::string::npos);
  EXPECT_NE(complaint(with("fromLane=\"1\"", "fromLane=\"7\"")).find("lane 7"), std::string::npos);
  EXPECT_NE(complaint(with("via=\":C_0_0\"", "via=\":C_9_0\"")).find(":C_9_0"), std::string::npos);
  EXPECT_NE(complaint(with("95,0 105,0", "95,0 nan,0")).find(":C_0_0"), std::string::npos);
  EXPECT_NE(complaint(with("response=\"10\"", "response=\"1\"")).find("'C'"), std::string::npos);
  EXPECT_NE(complaint(with("<neigh lane=\"in_1\"", "<neigh lane=\"in_8\"")).find("in_8"),
            std::string::npos);
  EXPECT_NE(complaint(with("speed=\"1.5\"", "speed=\"fast\"")).find("fast"), std::string::npos);
}

TEST_F(SumoNetReader, ReadsBuildingsAndBarriersOnly) {
  RoadNetwork net = read_sumo_net(write("a.net.xml", kNet));
  read_obstacles(write("p.xml", R"xml(<additional>
    <poly id="a" type="building.yes" shape="0,0 4,0 4,4 0,4 0,0"/>
    <poly id="b" type="leisure.park" shape="0,0 4,0 4,4 0,4 0,0"/>
    <poly id="c" type="barrier.wall" shape="9,9 12,9 12,12"/>
    <poly id="d" type="building" shape="0,0 1,1"/>
  </additional>)xml"),
                 net);
  ASSERT_EQ(net.obstacles.size(), 2u);
  EXPECT_EQ(net.obstacles[0].outline.size(), 4u);
  EXPECT_EQ(net.obstacles[1].kind, ObstacleKind::Barrier);
  EXPECT_EQ(net.obstacles[1].outline.size(), 3u);
  // SUMO takes any root
  read_obstacles(write("r.xml", "<pois><poly id='e' type='barrier' shape='0,0 1,1'/></pois>"), net);
  EXPECT_EQ(net.obstacles.size(), 3u);
  const fs::path bad =
      write("q.xml", "<additional><poly id='a' type='building' shape='1;2'/></additional>");
  EXPECT_THROW(read_obstacles(bad, net), Error);
}

TEST(VehicleClass, KnowsSumoNames) {
  EXPECT_EQ(vehicle_class_from_name("rail_urban"), vehicle_class::kRailUrban);
  EXPECT_EQ(vehicle_class_from_name("passenger"), vehicle_class::kPassenger);
  EXPECT_EQ(vehicle_class_from_name("ship"), vehicle_class::kShip);
  EXPECT_EQ(vehicle_class_from_name("public_transport"), vehicle_class::kBus);
  EXPECT_EQ(vehicle_class_from_name("cable_car"), vehicle_class::kOther);
  // each of SUMO's is one of its own
  VehicleClassMask seen = 0;
  for (const char* name :
       {"private",   "emergency",  "authority",  "army",          "vip",       "pedestrian",
        "passenger", "hov",        "taxi",       "bus",           "coach",     "delivery",
        "truck",     "trailer",    "motorcycle", "moped",         "bicycle",   "evehicle",
        "tram",      "rail_urban", "rail",       "rail_electric", "rail_fast", "ship",
        "custom1",   "custom2"}) {
    const VehicleClassMask mask = vehicle_class_from_name(name);
    EXPECT_EQ(mask & (mask - 1), 0u) << name;
    EXPECT_EQ(seen & mask, 0u) << name;
    EXPECT_NE(mask, vehicle_class::kOther) << name;
    seen |= mask;
  }
}

TEST_F(SumoNetReader, PermissionsAreSumosOwn) {
  const auto allowed = [&](const std::string& permissions) {
    const RoadNetwork net = read_sumo_net(write(
        "a.net.xml", with("index=\"1\" disallow=\"pedestrian\"", "index=\"1\" " + permissions)));
    return net.lane(net.lane_by_name.at("in_1")).allowed;
  };
  using namespace vehicle_class;
  EXPECT_EQ(allowed("allow=\"hov evehicle\""), kHov | kEvehicle);
  EXPECT_EQ(allowed(""), kAll);
  EXPECT_EQ(allowed("allow=\"\" disallow=\"private\""), ~kPrivate);
  EXPECT_EQ(allowed("allow=\"bus\" disallow=\"bus\""), kBus);
  EXPECT_EQ(allowed("disallow=\"all\""), 0u);
  EXPECT_EQ(allowed("allow=\"ignoring custom1\""), kCustom1);
}

// netconverts of some versions write index 0 for all lanes on a junction; SUMO counts by place
TEST_F(SumoNetReader, CountsLanesByTheirPlaceInTheFile) {
  const RoadNetwork net =
      read_sumo_net(write("a.net.xml", with("id=\"in_1\" index=\"1\"", "id=\"in_1\" index=\"0\"")));
  EXPECT_EQ(net.lane(net.lane_by_name.at("in_1")).index, 1);
}

TEST_F(SumoNetReader, TakesRequestsInAnyOrder) {
  const std::string first = "<request index=\"0\" response=\"10\" foes=\"10\" cont=\"1\"/>",
                    second = "<request index=\"1\" response=\"00\" foes=\"01\" cont=\"0\"/>";
  std::string net = with(first, "@");
  net.replace(net.find(second), second.size(), first);
  net.replace(net.find('@'), 1, second);
  const RoadNetwork read = read_sumo_net(write("a.net.xml", net));
  const Junction& junction = read.junction(read.junction_by_name.at("C"));
  EXPECT_TRUE(junction.requests[0].may_stop_inside);
  EXPECT_FALSE(junction.requests[1].may_stop_inside);
  EXPECT_NE(complaint(with("request index=\"1\"", "request index=\"7\"")).find("request 7"),
            std::string::npos);
}

}  // namespace
}  // namespace sumogamma
