#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "base/random.h"
#include "base/subprocess.h"
#include "io/config.h"
#include "road/sumo_net_reader.h"

namespace sumogamma {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

const fs::path kFixtures = fs::path(SUMOGAMMA_SOURCE_DIR) / "tests/support/osm";
const fs::path kMaps = fs::path(SUMOGAMMA_SOURCE_DIR) / "osm_maps";
const fs::path kSharedCases = fs::path(SUMOGAMMA_SHARED_DIR) / "cases/osm";
const fs::path kSharedMaps = fs::path(SUMOGAMMA_SHARED_DIR) / "data/maps";

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class ImportTest : public ::testing::Test {
 protected:
  ImportTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("import_" + std::to_string(getpid()) + "_" + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~ImportTest() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }

  ProcessRequest request(std::vector<std::string> arguments) const {
    ProcessRequest request;
    request.arguments = {SUMOGAMMA_PROGRAM, "import"};
    request.arguments.insert(request.arguments.end(), arguments.begin(), arguments.end());
    request.time_limit = 300.0;
    return request;
  }
  ProcessResult import(const fs::path& map, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {map.string(), "-o", out().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_process(request(arguments));
  }
  /// The same map for traffic on the other side.
  fs::path mirrored(const fs::path& map, const char* side) const {
    const fs::path file = folder_ / "mirrored.osm";
    ProcessRequest mirror;
    mirror.arguments = {(fs::path(SUMOGAMMA_SOURCE_DIR) / "tools/mirror_map.py").string(),
                        map.string(), file.string(), side};
    const ProcessResult result = run_process(mirror);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return file;
  }
  fs::path out() const { return folder_ / "out"; }
  fs::path put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// Exit code 2, one line, nothing left behind.
  void expect_refused(const ProcessResult& result, const std::string& words) const {
    EXPECT_EQ(result.exit_code, 2) << describe_end(result, 0) << "\n" << result.errors;
    EXPECT_EQ(result.signal, 0);
    EXPECT_THAT(result.errors, HasSubstr("sumo-gamma: "));
    EXPECT_THAT(result.errors, HasSubstr(words));
    expect_nothing_left();
  }
  void expect_nothing_left() const {
    for (const auto& entry : fs::directory_iterator(folder_))
      EXPECT_FALSE(entry.is_directory()) << entry.path() << " was left behind";
  }
  /// Plain SUMO on what was made: exit code 0. `report` gets its statistics.
  ProcessResult simulate(const std::string& end) const {
    ProcessRequest sumo;
    sumo.arguments = {"sumo",          "-c",  (out() / "scenario.sumocfg").string(), "--end", end,
                      "--step-length", "0.5", "--duration-log.statistics",           "true"};
    return run_process(sumo);
  }
  fs::path folder_;
};

TEST_F(ImportTest, MakesAWholeScenario) {
  const ProcessResult result =
      import(kFixtures / "signalled_crossing_right.osm", {"--agents", "30", "--duration", "120"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(out())) names.insert(entry.path().filename());
  EXPECT_EQ(names,
            (std::set<std::string>{"demand.rou.xml", "import.json", "net.net.xml", "netconvert.log",
                                   "obstacles.add.xml", "scenario.sumocfg", "scenario.toml"}));
  // the configuration that `run` reads, the report, and SUMO itself accept it
  EXPECT_EQ(read_config(out() / "scenario.toml").agents, 30);
  EXPECT_DOUBLE_EQ(read_config(out() / "scenario.toml").on_foot, 0.23);
  const auto report = nlohmann::json::parse(content(out() / "import.json"));
  EXPECT_EQ(report["built"]["signals"], 1);
  EXPECT_EQ(report["demand"]["agents"], 30);
  EXPECT_GT(report["demand"]["busiest_lane"]["load"], 0.0);
  EXPECT_EQ(simulate("120").exit_code, 0);
  // no path of this machine in what a user may pass on
  for (const std::string& name : names)
    EXPECT_THAT(content(out() / name), ::testing::Not(HasSubstr(folder_.string()))) << name;
}

/// How many of each type depart, and what was said.
std::map<std::string, int> departures(const fs::path& scenario) {
  std::map<std::string, int> counts;
  pugi::xml_document document;
  EXPECT_TRUE(document.load_file((scenario / "demand.rou.xml").c_str()));
  for (const pugi::xml_node one : document.document_element().children())
    if (one.attribute("depart")) ++counts[one.attribute("type").value()];
  return counts;
}

TEST_F(ImportTest, DrawsTheDemandThatIsAskedFor) {
  const fs::path demand = put("demand.toml",
                              "[demand]\nagents = 40\nprofile = [0.25, 1.0]\n"
                              "[demand.shares]\npedestrian = 0.7\ncar = 0.3\n");
  const ProcessResult result = import(kFixtures / "signalled_crossing_right.osm",
                                      {"--duration", "1200", "--demand", demand.string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const ScenarioConfig config = read_config(out() / "scenario.toml");
  EXPECT_EQ(config.agents, 40);
  EXPECT_DOUBLE_EQ(config.on_foot, 0.7);
  EXPECT_EQ(config.demand.profile, (std::vector<double>{0.25, 1.0}));
  const auto by_type = departures(out());
  EXPECT_EQ(by_type.size(), 2u);
  // four times as many depart in the second half
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file((out() / "demand.rou.xml").c_str()));
  int first = 0, second = 0;
  for (const pugi::xml_node one : document.document_element().children()) {
    const double depart = one.attribute("depart").as_double(-1);
    if (depart > 60 && depart < 600) ++first;
    if (depart >= 600) ++second;
  }
  EXPECT_NEAR(static_cast<double>(second) / first, 4.0 * 600 / 540, 1.3);

  // drawn anew, as scenario.toml and --set ask; the rest of the file stays
  ProcessRequest again;
  again.arguments = {SUMOGAMMA_PROGRAM, "demand", out().string(), "--set",
                     "demand.shares.pedestrian=0.0"};
  const ProcessResult drawn = run_process(again);
  ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  EXPECT_EQ(departures(out()).count("pedestrian"), 0u);
  EXPECT_DOUBLE_EQ(read_config(out() / "scenario.toml").on_foot, 0);
  EXPECT_EQ(simulate("200").exit_code, 0);
}

TEST_F(ImportTest, MeetsCountsAndTablesOfTrips) {
  ASSERT_EQ(import(kFixtures / "signalled_crossing_right.osm", {"--duration", "600"}).exit_code, 0);
  // an edge that cars drive in from, and where they go
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file((out() / "demand.rou.xml").c_str()));
  std::string from, to;
  for (const pugi::xml_node one : document.document_element().children("vehicle")) {
    std::istringstream edges(one.child("route").attribute("edges").value());
    edges >> from >> to;
    if (!to.empty()) break;
  }
  ASSERT_FALSE(to.empty());
  put("counts.xml", "<data><interval begin=\"0\" end=\"3600\"><edge id=\"" + from +
                        "\" entered=\"300\"/></interval></data>");
  put("od.csv", "from,to,type,per_hour\n" + from + "," + to + ",bus,60\n");
  const fs::path demand =
      put("demand.toml", "[demand]\nod = \"od.csv\"\ncounts = \"counts.xml\"\n");
  const ProcessResult result =
      import(kFixtures / "signalled_crossing_right.osm",
             {"--duration", "3600", "--force", "--demand", demand.string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("counts: 1 of 1 met"));
  EXPECT_NEAR(departures(out()).at("bus"), 60, 8);
  int entered = 0;
  ASSERT_TRUE(document.load_file((out() / "demand.rou.xml").c_str()));
  for (const pugi::xml_node one : document.document_element().children("vehicle"))
    entered += (" " + std::string(one.child("route").attribute("edges").value()) + " ")
                   .find(" " + from + " ") != std::string::npos;
  EXPECT_NEAR(entered, 300, 40);
  EXPECT_TRUE(fs::exists(out() / "od.csv"));
  EXPECT_TRUE(fs::exists(out() / "counts.xml"));
}

TEST_F(ImportTest, RefusesADemandThatCannotBeMeant) {
  const fs::path map = kFixtures / "signalled_crossing_right.osm";
  const auto refused = [&](const std::string& demand, const std::string& words) {
    expect_refused(import(map, {"--demand", put("demand.toml", demand).string()}), words);
  };
  refused("[demand]\nprofil = [1.0]\n", "nearest known one is 'demand.profile'");
  refused("[demand.shares]\npedestrain = 0.5\n", "'demand.shares.pedestrian'");
  refused("[demand]\nprofile = [0.0, 0.0]\n", "must have a part above 0");
  refused("[demand]\nwindow = [1.0, 2.0]\n", "W, S, E, N");
  refused("[demand]\nwindow = [1.0, 2.0, 1.1, 2.1]\n", "outside of the network");
  refused("[demand]\nod = \"none.csv\"\n", "none.csv");
  refused("[run]\nagents = 5\n", "none of [demand]");
  put("od.csv", "from,to,type,per_hour\nnowhere,elsewhere,car,60\n");
  refused("[demand]\nod = \"od.csv\"\n", "no edge 'nowhere'");
}

struct Place {
  const char* map;
  const char* fact;
  double expected;
};

class FixtureTest : public ImportTest,
                    public ::testing::WithParamInterface<std::tuple<Place, const char*>> {
 protected:
  FixtureTest() {
    folder_ += std::string(std::get<0>(GetParam()).map) +
               std::get<1>(GetParam());  // parameters share a name
    fs::create_directories(folder_);
  }
};

TEST_P(FixtureTest, IsBuiltOnItsSideAndRunsInSumo) {
  const auto& [place, side] = GetParam();
  const ProcessResult result = import(kFixtures / (std::string(place.map) + "_" + side + ".osm"),
                                      {"--agents", "20", "--duration", "100"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto report = nlohmann::json::parse(content(out() / "import.json"));
  EXPECT_EQ(report["left_hand"], std::string(side) == "left");
  EXPECT_EQ(report["built"][place.fact], place.expected) << report["built"].dump(1);
  EXPECT_EQ(read_sumo_net(out() / "net.net.xml").left_hand, std::string(side) == "left");
  const ProcessResult sumo = simulate("100");
  EXPECT_EQ(sumo.exit_code, 0) << sumo.errors;
}

INSTANTIATE_TEST_SUITE_P(
    Fixtures, FixtureTest,
    ::testing::Combine(::testing::Values(Place{"signalled_crossing", "signals", 1},
                                         Place{"roundabout", "roundabout_junctions", 4},
                                         Place{"two_way_stop", "crossings", 4},
                                         Place{"zebra", "crossings", 1},
                                         Place{"bridge", "car_components", 2},
                                         Place{"square", "walk_components", 1}),
                       ::testing::Values("right", "left")),
    [](const auto& row) {
      return std::string(std::get<0>(row.param).map) + "_" + std::get<1>(row.param);
    });

TEST_F(ImportTest, StopSignsRuleTheirJunction) {
  ASSERT_EQ(
      import(kFixtures / "two_way_stop_right.osm", {"--agents", "5", "--duration", "60"}).exit_code,
      0);
  const RoadNetwork road = read_sumo_net(out() / "net.net.xml");
  EXPECT_EQ(road.junction(road.junction_by_name.at("1")).type, "priority_stop");
}

TEST_F(ImportTest, ARepairCanBeLeftOut) {
  const fs::path map = kFixtures / "two_way_stop_right.osm";
  ASSERT_EQ(import(map, {"--without", "stop-signs", "--without", "kerbs"}).exit_code, 0);
  const auto report = nlohmann::json::parse(content(out() / "import.json"));
  EXPECT_EQ(report["repairs_left_out"], (nlohmann::json{"kerbs", "stop-signs"}));
  for (const Junction& junction : read_sumo_net(out() / "net.net.xml").junctions)
    EXPECT_NE(junction.type, "priority_stop");
}

TEST_F(ImportTest, ABridgeIsAboveTheRoadBelow) {
  ASSERT_EQ(import(kFixtures / "bridge_left.osm", {"--agents", "5", "--duration", "60"}).exit_code,
            0);
  const RoadNetwork road = read_sumo_net(out() / "net.net.xml");
  double highest = 0;
  for (const Lane& lane : road.lanes)
    for (const double z : lane.elevation) highest = std::max(highest, z);
  EXPECT_NEAR(highest, 5.0, 0.5);
}

// tools/mirror_map.py: the same map for traffic on the other side
TEST_F(ImportTest, AMirroredMapHasTheSameNetworkOnTheOtherSide) {
  const std::string tags = content(
      mirrored(put("tags.osm",
                   R"(<osm version="0.6"><node id="1" lat="48" lon="11"/><way id="2"><nd ref="1"/>
  <tag k="turn:lanes:forward" v="left|through;right"/><tag k="sidewalk" v="right"/>
  <tag k="cycleway:left" v="track"/><tag k="name" v="Left Bank"/></way></osm>)"),
               "right"));
  for (const char* tag :
       {R"(k="turn:lanes:forward" v="through;left|right")", R"(k="sidewalk" v="left")",
        R"(k="cycleway:right" v="track")", R"(k="name" v="Left Bank")"})
    EXPECT_THAT(tags, HasSubstr(tag));

  nlohmann::json built[2];
  for (const bool mirror : {false, true}) {
    const fs::path map = kFixtures / "signalled_crossing_right.osm";
    ASSERT_EQ(import(mirror ? mirrored(map, "right") : map, {"--force"}).exit_code, 0);
    const auto report = nlohmann::json::parse(content(out() / "import.json"));
    EXPECT_EQ(report["left_hand"], mirror);
    built[mirror] = report["built"];
  }
  for (const char* what : {"edges", "lanes", "connections", "crossings", "junctions", "signals"})
    EXPECT_EQ(built[0][what], built[1][what]) << what;
  EXPECT_NEAR(built[0]["kilometres"], built[1]["kilometres"], 0.01);
}

TEST_F(ImportTest, MonacoRunsWithAHundredAlive) {
  const ProcessResult result = import(kMaps / "monaco.osm.pbf", {"--duration", "400"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("netconvert"));  // progress
  const auto report = nlohmann::json::parse(content(out() / "import.json"));
  for (const char* type : {"car", "van", "bus", "truck", "motorcycle", "bicycle", "pedestrian"}) {
    EXPECT_EQ(report["demand"]["by_type"][type]["left_out"], "") << type;
    EXPECT_GT(report["demand"]["by_type"][type]["departures"], 0) << type;
  }
  EXPECT_GT(report["obstacles"]["buildings"], 400);
  // two junctions 6 m apart, which netconvert leaves as they are
  const RoadNetwork road = read_sumo_net(out() / "net.net.xml");
  EXPECT_TRUE(road.junction_by_name.contains("cluster_25191494_25191502"));
  const ProcessResult sumo = simulate("200");
  ASSERT_EQ(sumo.exit_code, 0) << sumo.errors;
  const auto running = [&](const char* key) {
    const std::size_t at = sumo.output.find(key);
    return at == std::string::npos
               ? 0L
               : std::stol(sumo.output.substr(sumo.output.find_first_of("0123456789", at)));
  };
  EXPECT_GT(running("Running:"), 60) << sumo.output;  // vehicles; people on foot are counted apart
}

TEST_F(ImportTest, CutsToABox) {
  ASSERT_EQ(import(kMaps / "monaco.osm.pbf", {"--bbox", "7.418,43.732,7.426,43.738", "--quiet"})
                .exit_code,
            0);
  const RoadNetwork road = read_sumo_net(out() / "net.net.xml");
  // 0.008 degrees of longitude are 644 m here, 0.006 of latitude 667 m, and 60 m are kept on each
  // side
  EXPECT_NEAR((road.upper_corner - road.lower_corner).x(), 764, 20);
  EXPECT_NEAR((road.upper_corner - road.lower_corner).y(), 787, 20);
  EXPECT_NEAR((road.upper_corner + road.lower_corner).norm() / 2, 0, 15);
}

TEST_F(ImportTest, GivesTheSameBytesForTheSameSeed) {
  const fs::path map = kMaps / "fujisawa.osm.pbf";
  std::map<std::string, std::string> first;
  ASSERT_EQ(import(map, {"--seed", "7", "--duration", "200"}).exit_code, 0);
  for (const auto& entry : fs::directory_iterator(out()))
    first[entry.path().filename()] = content(entry.path());
  fs::remove_all(out());
  ASSERT_EQ(import(map, {"--seed", "7", "--duration", "200"}).exit_code, 0);
  for (const auto& [name, text] : first) {
    EXPECT_EQ(content(out() / name), text) << name;
  }
  fs::remove_all(out());
  ASSERT_EQ(import(map, {"--seed", "8", "--duration", "200"}).exit_code, 0);
  EXPECT_EQ(content(out() / "net.net.xml"), first["net.net.xml"]);
  EXPECT_NE(content(out() / "demand.rou.xml"), first["demand.rou.xml"]);
}

TEST_F(ImportTest, DemandIsSortedRoutableAndSpreadOverTypes) {
  ASSERT_EQ(import(kMaps / "fujisawa.osm.pbf", {"--agents", "200", "--duration", "300"}).exit_code,
            0);
  const RoadNetwork road = read_sumo_net(out() / "net.net.xml");
  pugi::xml_document demand;
  ASSERT_TRUE(demand.load_file((out() / "demand.rou.xml").c_str()));
  double before = 0;
  int first_half_minute = 0;
  std::map<std::string, int> by_type;
  for (const pugi::xml_node agent : demand.child("routes").children()) {
    if (std::string_view(agent.name()) == "vType") continue;
    const std::string id = agent.attribute("id").value(), type = agent.attribute("type").value();
    const double depart = agent.attribute("depart").as_double(-1);
    EXPECT_GE(depart, before) << id;
    before = depart;
    first_half_minute += depart < 30;
    ++by_type[type];
    const pugi::xml_node trip = agent.child(type == "pedestrian" ? "walk" : "route");
    std::istringstream names(trip.attribute("edges").value());
    const Edge* last = nullptr;
    for (std::string name; names >> name;) {
      ASSERT_TRUE(road.edge_by_name.contains(name)) << id << " " << name;
      const Edge& edge = road.edge(road.edge_by_name.at(name));
      if (last && type != "pedestrian") {
        EXPECT_EQ(last->to, edge.from) << id << " " << name;
      }
      if (last && type == "pedestrian") {
        // people walk either way, and round the corner, but never from nowhere
        EXPECT_TRUE(last->to == edge.from || last->to == edge.to || last->from == edge.from ||
                    last->from == edge.to)
            << id << " " << name;
      }
      last = &edge;
    }
    EXPECT_NE(last, nullptr) << id;
  }
  EXPECT_GE(first_half_minute, 200);
  EXPECT_LE(first_half_minute, 400);
  EXPECT_EQ(by_type.size(), 7u);
  EXPECT_LT(before, 300);
}

class SharedMapTest : public ImportTest, public ::testing::WithParamInterface<const char*> {
 protected:
  SharedMapTest() {
    folder_ += GetParam();
    fs::create_directories(folder_);
  }
};

TEST_P(SharedMapTest, RunsInSumo) {
  const fs::path map = kSharedMaps / GetParam();
  if (!fs::exists(map))
    GTEST_SKIP() << "no " << map << ": the extracts that do not ship are not here";
  const ProcessResult result = import(map);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const ProcessResult sumo = simulate("300");
  EXPECT_EQ(sumo.exit_code, 0) << sumo.errors;
}

INSTANTIATE_TEST_SUITE_P(Maps, SharedMapTest,
                         ::testing::Values("meskel_square.osm", "magic.osm", "highway.osm",
                                           "beijing.osm", "shi_men_er_lu.osm", "berlin.osm.pbf"),
                         [](const auto& row) {
                           const std::string name = row.param;
                           return name.substr(0, name.find('.'));
                         });

// of Shi Men Er Lu the extract holds 228 m of a road that nothing leads to, of the motorway one of
// its carriageways is like that; along the other one there is a bay for buses
TEST_F(ImportTest, FewTripsStayOnARoadThatStandsAlone) {
  const auto share_within_edge = [&](const char* map) {
    EXPECT_EQ(import(kSharedMaps / map, {"--force"}).exit_code, 0);
    pugi::xml_document demand;
    EXPECT_TRUE(demand.load_file((out() / "demand.rou.xml").c_str()));
    std::set<std::string> types;
    double all = 0, within = 0;
    for (const pugi::xml_node agent : demand.child("routes").children("vehicle")) {
      types.insert(agent.attribute("type").value());
      const std::string_view edges = agent.child("route").attribute("edges").value();
      ++all;
      within += edges.find(' ') == std::string_view::npos;
    }
    EXPECT_EQ(types.size(), 6u) << map;
    return within / all;
  };
  if (!fs::exists(kSharedMaps)) GTEST_SKIP() << "no " << kSharedMaps << ": its extracts don't ship";
  EXPECT_LT(share_within_edge("shi_men_er_lu.osm"), 0.05);
  EXPECT_GT(share_within_edge("highway.osm"), 0.2);
}

// there a queue at the signal would stand across a turn over it, drawn over the junction before
TEST_F(ImportTest, JunctionsWhoseWaysLieOnEachOtherAtASignalAreMadeOne) {
  const fs::path map = kSharedMaps / "shi_men_er_lu.osm";
  if (!fs::exists(map))
    GTEST_SKIP() << "no " << map << ": the extracts that don't ship aren't here";
  const auto joined = [&](const fs::path& file) {
    EXPECT_EQ(import(file, {"--force", "--agents", "10", "--duration", "60"}).exit_code, 0);
    const auto report = nlohmann::json::parse(content(out() / "import.json"));
    long count = 0;
    for (const auto& issue : report["issues"])
      if (issue["kind"] == "junctions_joined") count += issue["count"].get<long>();
    return count;
  };
  EXPECT_EQ(joined(map), 0);
  EXPECT_EQ(joined(mirrored(map, "right")), 1);
}

class OverlapTest : public SharedMapTest {};

TEST_P(OverlapTest, LanesOfDifferentEdgesAreMovedApart) {
  const fs::path map = kSharedMaps / GetParam();
  if (!fs::exists(map))
    GTEST_SKIP() << "no " << map << ": the extracts that do not ship are not here";
  ASSERT_EQ(import(map, {"--agents", "10", "--duration", "60"}).exit_code, 0);
  const auto built = nlohmann::json::parse(content(out() / "import.json"))["built"];
  const double before = built["overlapping_lanes_before_m"];
  EXPECT_GT(before, 500);
  EXPECT_LT(built["overlapping_lanes_m"], before / 10);
  EXPECT_LE(built["overlapping_walkways_m"], built["overlapping_walkways_before_m"]);
}

INSTANTIATE_TEST_SUITE_P(Maps, OverlapTest,
                         ::testing::Values("meskel_square.osm", "shi_men_er_lu.osm"),
                         [](const auto& row) {
                           const std::string name = row.param;
                           return name.substr(0, name.find('.'));
                         });

TEST_F(ImportTest, RefusesWhatIsNoMap) {
  expect_refused(import(folder_ / "none.osm"), "no such file");
  expect_refused(import(kFixtures), "is a folder");
  expect_refused(import(put("page.osm", "<html></html>")), "page.osm");
  expect_refused(import(put("text.osm.pbf", "hello")), "text.osm.pbf");
  const std::string map = content(kFixtures / "zebra_right.osm");
  expect_refused(import(put("cut.osm", map.substr(0, map.size() / 2))), "cut.osm");
  const std::string pbf = content(kMaps / "fujisawa.osm.pbf");
  expect_refused(import(put("cut.osm.pbf", pbf.substr(0, pbf.size() / 2))), "cut.osm.pbf");
  expect_refused(
      import(put("nodes.osm", "<osm version=\"0.6\"><node id=\"1\" lat=\"48\" lon=\"11\"/></osm>")),
      "no roads");
}

TEST_F(ImportTest, RefusesBadOptions) {
  const fs::path map = kFixtures / "zebra_right.osm";
  for (const char* agents : {"0", "-3", "many", "2.5", "nan", "1e99"})
    expect_refused(import(map, {"--agents", agents}), "--agents");
  for (const char* duration : {"0", "-3", "long"})
    expect_refused(import(map, {"--duration", duration}), "--duration");
  for (const char* box : {"1,2,3", "a,b,c,d", "12,48,11,49", "200,0,201,1", "1,2,3,4,5", ""})
    expect_refused(import(map, {"--bbox", box}), "--bbox");
  expect_refused(import(map, {"--bbox", "20,20,21,21"}), "outside the extract");
  expect_refused(import(map, {"--bbox", "11.01,47.9,11.02,48.1"}), "outside the extract");
}

TEST_F(ImportTest, RefusesARepairThatItDoesNotKnow) {
  expect_refused(import(kFixtures / "zebra_right.osm", {"--without", "stop-sign"}), "stop-signs?");
}

TEST_F(ImportTest, RefusesAFolderThatIsNotItsOwn) {
  fs::create_directory(out());
  put("out/mine", "precious");
  const ProcessResult result = import(kFixtures / "zebra_right.osm");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("--force"));
  EXPECT_EQ(content(out() / "mine"), "precious");
  EXPECT_EQ(import(kFixtures / "zebra_right.osm", {"--force", "--agents", "5", "--duration", "60"})
                .exit_code,
            0);
  EXPECT_EQ(content(out() / "mine"), "precious");
  EXPECT_TRUE(fs::exists(out() / "net.net.xml"));
}

TEST_F(ImportTest, NamesAFolderThatCannotBeWritten) {
  const ProcessResult result =
      run_process(request({(kFixtures / "zebra_right.osm").string(), "-o", "/proc/out"}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("/proc/out"));
}

TEST_F(ImportTest, SaysWhenNetconvertIsMissing) {
  ProcessRequest import_request =
      request({(kFixtures / "zebra_right.osm").string(), "-o", out().string()});
  import_request.environment = {{"PATH", "/nowhere"}, {"SUMO_HOME", ""}};
  expect_refused(run_process(import_request), "netconvert: not found");
}

TEST_F(ImportTest, PassesOnWhatAFailingToolSaid) {
  const fs::path tools = fs::temp_directory_path() / ("tools_" + std::to_string(getpid()));
  fs::create_directories(tools);
  const auto with_tool = [&](const std::string& name, const std::string& script) {
    std::ofstream(tools / name) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(tools / name, fs::perms::owner_all);
    ProcessRequest import_request =
        request({(kFixtures / "zebra_right.osm").string(), "-o", out().string()});
    import_request.environment = {{"PATH", tools.string() + ":/usr/bin:/bin"}, {"SUMO_HOME", ""}};
    const ProcessResult result = run_process(import_request);
    fs::remove(tools / name);
    return result;
  };
  expect_refused(with_tool("netconvert", "echo 'Error: nodes are upside down' >&2; exit 1"),
                 "nodes are upside down");
  expect_refused(with_tool("netconvert", "kill -SEGV $$"), "signal 11");
  expect_refused(with_tool("netconvert", "exit 0"), "netconvert");
  expect_refused(with_tool("netconvert", "printf '<net><edge' > net.net.xml"), "in part only");
  expect_refused(with_tool("duarouter", "echo 'Error: lost' >&2; exit 1"), "lost");
  fs::remove_all(tools);
}

TEST_F(ImportTest, SaysWhenTheDiskIsFull) {
  // a limit on the size of files stands in for a disk without room: writing fails alike, with EFBIG
  // for ENOSPC
  for (const char* kilobytes : {"4", "40", "100", "200", "400"}) {
    ProcessRequest limited;
    limited.arguments = {
        "sh", "-c",
        "trap '' XFSZ; ulimit -f " + std::string(kilobytes) + "; exec '" + SUMOGAMMA_PROGRAM +
            "' import '" + (kMaps / "fujisawa.osm.pbf").string() + "' -o '" + out().string() + "'"};
    const ProcessResult result = run_process(limited);
    EXPECT_EQ(result.exit_code, 2) << kilobytes << ": " << describe_end(result, 0) << result.errors;
    expect_nothing_left();
  }
}

TEST_F(ImportTest, LeavesNothingWhenInterrupted) {
  // stopped as soon as the staging folder holds a network: run_process sends SIGTERM, as a shell's
  // kill would
  ProcessRequest import_request =
      request({(kMaps / "monaco.osm.pbf").string(), "-o", out().string()});
  import_request.should_stop = [&] {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()) > 0;
  };
  const ProcessResult result = run_process(import_request);
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.exit_code, 130) << describe_end(result, 0);
  expect_nothing_left();
}

/// Ways on which a class may drive in a network, by the map's ids: "5000", "-5000" against it.
std::set<std::string> ways_open_to(const RoadNetwork& road, VehicleClassMask vehicle) {
  std::set<std::string> ways;
  for (const Edge& edge : road.edges)
    if (edge.kind == LaneKind::Normal && allows(road, edge, vehicle))
      ways.insert(edge.name.substr(0, edge.name.find('#')));
  return ways;
}

/// An unloaded grid of streets of 150 m; the first way has the tags, node 1 is its first one.
std::string grid_with(const std::string& tags) {
  std::string map = "<osm version='0.6'>";
  for (int i = 0; i < 9; ++i)
    map += "<node id='" + std::to_string(i + 1) + "' lat='" +
           std::to_string(48 + 0.0014 * (i / 3)) + "' lon='" + std::to_string(9 + 0.002 * (i % 3)) +
           "'/>";
  const auto way = [&](int id, int a, int b, int c, const std::string& more) {
    map += "<way id='" + std::to_string(id) + "'>";
    for (const int node : {a, b, c}) map += "<nd ref='" + std::to_string(node) + "'/>";
    map += "<tag k='highway' v='residential'/>" + more + "</way>";
  };
  way(100, 4, 5, 6, tags);
  way(101, 1, 2, 3, "");
  way(102, 7, 8, 9, "");
  for (int i = 1; i <= 3; ++i) way(102 + i, i, i + 3, i + 6, "");
  return map + "</osm>";
}

std::string as_tag(const std::string& key, const std::string& value) {
  return "<tag k='" + key + "' v='" + value + "'/>";
}

TEST_F(ImportTest, BicyclesRideAgainstTheTrafficWhereTheMapSaysSo) {
  using namespace vehicle_class;
  for (const auto& [key, value] :
       {std::pair{"oneway:bicycle", "no"}, std::pair{"cycleway", "opposite"}}) {
    const auto result =
        import(put("map.osm", grid_with(as_tag("oneway", "yes") + as_tag(key, value))),
               {"--agents", "5", "--duration", "60", "--force"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const RoadNetwork road = read_sumo_net(out() / "net.net.xml");
    EXPECT_TRUE(ways_open_to(road, kBicycle).contains("-100")) << key;
    EXPECT_FALSE(ways_open_to(road, kPassenger).contains("-100")) << key;
    EXPECT_TRUE(ways_open_to(road, kPassenger).contains("100")) << key;
  }
}

TEST_F(ImportTest, MoreSpecificTagsOfAccessHold) {
  using namespace vehicle_class;
  const auto import_with = [&](const std::string& tags) {
    const auto result =
        import(put("map.osm", grid_with(tags)), {"--agents", "5", "--duration", "60", "--force"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return read_sumo_net(out() / "net.net.xml");
  };
  const RoadNetwork bus = import_with(as_tag("access", "no") + as_tag("bus", "yes"));
  EXPECT_TRUE(ways_open_to(bus, kBus).contains("100"));
  for (const VehicleClassMask shut : {kPassenger, kTruck, kMotorcycle, kBicycle, kPedestrian})
    EXPECT_FALSE(ways_open_to(bus, shut).contains("100")) << shut;
  const RoadNetwork motorcycle =
      import_with(as_tag("motorcar", "no") + as_tag("motorcycle", "yes"));
  EXPECT_TRUE(ways_open_to(motorcycle, kMotorcycle).contains("100"));
  EXPECT_TRUE(ways_open_to(motorcycle, kPedestrian).contains("100"));
  EXPECT_FALSE(ways_open_to(motorcycle, kPassenger).contains("100"));
}

TEST_F(ImportTest, TypingErrorsAreBoundedAndSaid) {
  for (const auto& [key, value, kind] : {std::tuple{"lanes", "99", "lanes_not_meant"},
                                         std::tuple{"maxspeed", "0", "maxspeed_not_meant"},
                                         std::tuple{"maxspeed", "999", "maxspeed_not_meant"},
                                         std::tuple{"layer", "99", "layer_not_meant"}}) {
    const auto result = import(put("map.osm", grid_with(as_tag(key, value))),
                               {"--agents", "5", "--duration", "60", "--force"});
    ASSERT_EQ(result.exit_code, 0) << key << result.errors;
    const auto report = nlohmann::json::parse(content(out() / "import.json"));
    const auto& issues = report.at("issues");
    EXPECT_TRUE(std::any_of(issues.begin(), issues.end(), [&](const nlohmann::json& issue) {
      return issue.at("kind") == kind && issue.at("severity") == "warning";
    })) << key;
    const RoadNetwork road = read_sumo_net(out() / "net.net.xml");
    EXPECT_TRUE(ways_open_to(road, vehicle_class::kPassenger).contains("100")) << key;
    for (const Edge& edge : road.edges) EXPECT_LE(edge.lanes.size(), 4u);
  }
}

class ReportedCaseTest : public ImportTest,
                         public ::testing::WithParamInterface<std::pair<const char*, const char*>> {
};

TEST_P(ReportedCaseTest, IsReadOrSaysWhatHelps) {
  const fs::path map = kSharedCases / GetParam().first;
  if (!fs::exists(map)) GTEST_SKIP() << "no " << map << ": the reported cases don't ship";
  const ProcessResult result = import(map, {"--agents", "5", "--duration", "60"});
  if (result.exit_code == 2) return expect_refused(result, GetParam().second);
  ASSERT_EQ(result.exit_code, 0) << describe_end(result, 0) << result.errors;
  EXPECT_THAT(result.output + content(out() / "import.json"), HasSubstr(GetParam().second));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, ReportedCaseTest,
    ::testing::Values(
        std::pair{"f_overpass_remark.osm", "not whole"}, std::pair{"f_geom_member.osm", ""},
        std::pair{"f_osmnx_version1.osm", ""}, std::pair{"f_lat91.osm", "node 1000 at latitude 91"},
        std::pair{"f_one_way.osm", "f_one_way.osm: nobody can travel"},
        std::pair{"l_99.osm", "lanes=99"}, std::pair{"t_oneway.osm", "oneway_by_hour"},
        std::pair{"t_access.osm", "closed_to_some"}, std::pair{"t_lanes.osm", "lanes_not_meant"},
        std::pair{"t_maxspeed.osm", "maxspeed_not_meant"}),
    [](const auto& one) {
      return std::string(one.param.first, std::string(one.param.first).find('.'));
    });

TEST_F(ImportTest, SurvivesDamagedMaps) {
  // whole pipeline: a flipped bit may leave a readable map, and then it must still build or be
  // refused
  const std::string whole = content(kFixtures / "square_left.osm");
  for (std::uint64_t i = 0; i < 25; ++i) {
    std::string damaged = whole;
    const auto at = static_cast<std::size_t>(random_uniform(3, i, 0, Draw::Demand) *
                                             static_cast<double>(whole.size()));
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (i % 7)));
    const ProcessResult result =
        import(put("damaged.osm", damaged), {"--agents", "5", "--duration", "60", "--quiet"});
    EXPECT_EQ(result.signal, 0) << "bit " << i % 7 << " of byte " << at;
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2)
        << "byte " << at << ": " << describe_end(result, 0);
    if (result.exit_code == 2) expect_nothing_left();
    fs::remove_all(out());
  }
}

}  // namespace
}  // namespace sumogamma
