#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "support/lanelet_text.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

ProcessResult program(std::vector<std::string> arguments) {
  ProcessRequest request;
  request.arguments = std::move(arguments);
  request.time_limit = 300.0;
  request.output_limit = 1 << 24;
  return run_process(request);
}

ProcessResult scene_from(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {SUMOGAMMA_PROGRAM, "scene-from", "--quiet"});
  return program(std::move(arguments));
}

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class SceneFrom : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scene_from_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Cars along y = `aside` towards +x, the third of which comes after three seconds, and a walker.
  std::string recording(double aside) const {
    const fs::path file = folder_ / "rec.csv";
    std::ofstream out(file);
    out << "time_s,agent_id,agent_type,x_m,y_m,heading_rad,length_m,width_m\n";
    for (int k = 0; k <= 120; ++k) {
      const double time = 0.1 * k;
      out << time << ",1,car," << -120 + 9 * time << "," << aside << ",0,4.5,1.8\n";
      out << time << ",2,car," << -150 + 9 * time << "," << aside << ",0,4.2,1.7\n";
      if (k >= 30)
        out << time << ",3,truck," << -180 + 9 * (time - 3) << "," << aside << ",0,9,2.5\n";
      out << time << ",4,pedestrian," << -100 + 1.2 * time << "," << aside - 3.5 << ",0,,\n";
    }
    return file.string();
  }
  std::string net() const {
    const fs::path file = folder_ / "road.net.xml";
    testing::write_plain_net(
        {R"(<node id="W" x="-200" y="0"/><node id="C" x="0" y="0"/><node id="E" x="200" y="0"/>)",
         R"(<edge id="WC" from="W" to="C" numLanes="1" speed="14" sidewalkWidth="2"/>)"
         R"(<edge id="CE" from="C" to="E" numLanes="1" speed="14" sidewalkWidth="2"/>)",
         "",
         {}},
        file);
    return file.string();
  }
  std::string lanelets() const {
    std::ofstream(folder_ / "map.osm") << testing::lanelet_crossing();
    return (folder_ / "map.osm").string();
  }
  std::string out() const { return (folder_ / "out").string(); }
  json told() const { return json::parse(std::ifstream(folder_ / "out" / "scene.json")); }
  fs::path folder_;
};

TEST_F(SceneFrom, OpenGroundIsASceneThatIsDriven) {
  const ProcessResult result = scene_from({recording(0), "-o", out()});
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_NE(result.output.find("nobody comes"), std::string::npos) << result.output;
  EXPECT_EQ(told().at("present"), 3);
  EXPECT_EQ(told().at("arriving"), 1);
  EXPECT_EQ(told().at("default_boxes"), 1);
  const std::string arrivals = content(folder_ / "out" / "arrivals.csv");
  EXPECT_NE(arrivals.find("\n2.0,3,truck,-180.0000,"), std::string::npos) << arrivals;
  const ProcessResult driven =
      program({SUMOGAMMA_PROGRAM, "scene", out() + "/scene.csv", "--steps", "100"});
  ASSERT_TRUE(driven.ok()) << driven.errors;
  const json figures = json::parse(driven.output);
  EXPECT_EQ(figures.at("agents"), 3);
  EXPECT_EQ(figures.at("agents_overlapped_share"), 0.0);
  EXPECT_GT(figures.at("progress_mean"), 0.8);
}

TEST_F(SceneFrom, ANetworkMakesAScenarioOfSumos) {
  // the lane's middle lies 1.6 m right of the edge's line, behind 2 m of sidewalk
  const ProcessResult result = scene_from({recording(-1.6), "--map", net(), "-o", out()});
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_EQ(told().at("vehicles"), 3);
  EXPECT_EQ(told().at("people"), 1);
  EXPECT_EQ(told().at("points"), told().at("points_on_routes"));
  const ProcessResult sumo =
      program({"sumo", "-c", out() + "/recorded.sumocfg", "--tripinfo-output",
               (folder_ / "trips.xml").string(), "--no-step-log", "--duration-log.disable"});
  ASSERT_TRUE(sumo.ok()) << sumo.errors;
  const std::string trips = content(folder_ / "trips.xml");
  for (const char* id : {"1", "2", "3"})
    EXPECT_NE(trips.find(std::string("<tripinfo id=\"") + id + "\""), std::string::npos) << trips;
  const ProcessResult driven = program({SUMOGAMMA_PROGRAM, "run", out() + "/recorded.sumocfg", "-o",
                                        (folder_ / "run").string(), "--quiet"});
  ASSERT_TRUE(driven.ok()) << driven.errors;
  const json results = json::parse(std::ifstream(folder_ / "run" / "results.json"));
  EXPECT_EQ(results.at("agents").at("inserted"), 4);
  EXPECT_EQ(results.at("collisions").at("unique_pairs"), 0);
}

TEST_F(SceneFrom, ALanelet2MapMakesOne) {
  const ProcessResult result =
      scene_from({recording(1.75), "--map", lanelets(), "-o", out(), "--beyond", "150"});
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_NE(result.output.find("left out of the map: 1 lanelets for people (crosswalk)"),
            std::string::npos)
      << result.output;
  EXPECT_EQ(told().at("vehicles"), 3);
  EXPECT_EQ(told().at("people_without_a_sidewalk"), 1);
  EXPECT_EQ(told().at("points"), told().at("points_on_routes"));
  EXPECT_EQ(told().at("lanelets").at("ways_over_junctions"), 4);
  for (const char* file : {"map.net.xml", "lanelets/map.edg.xml", "lanelets/map.con.xml"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;
  EXPECT_FALSE(fs::exists(folder_ / "out" / "lanelets" / "map.net.xml"));
  const ProcessResult sumo = program(
      {"sumo", "-c", out() + "/recorded.sumocfg", "--no-step-log", "--duration-log.disable"});
  EXPECT_TRUE(sumo.ok()) << sumo.errors;
  const ProcessResult driven = program({SUMOGAMMA_PROGRAM, "run", out() + "/recorded.sumocfg", "-o",
                                        (folder_ / "run").string(), "--quiet"});
  ASSERT_TRUE(driven.ok()) << driven.errors;
  const json results = json::parse(std::ifstream(folder_ / "run" / "results.json"));
  EXPECT_EQ(results.at("agents").at("inserted"), 3);
  EXPECT_EQ(results.at("collisions").at("unique_pairs"), 0);
}

/// A junction with turning lanes, slip roads and a lane that the map lacks.
TEST_F(SceneFrom, ARealRecordingLiesOnItsLanelets) {
  const fs::path data = fs::path(SUMOGAMMA_SHARED_DIR) / "data" / "trajectories" / "tafbw_k733";
  if (!fs::exists(data)) GTEST_SKIP() << "no recordings beside the project: " << data;
  const std::vector<std::string> arguments = {
      (data / "k733_2020_09_15.csv").string(), "--period", "0.1", "--map",
      (data / "k733.lanelet2.osm").string(),   "-o",       out()};
  EXPECT_NE(scene_from(arguments).errors.find("--origin LAT,LON"), std::string::npos);
  std::vector<std::string> placed = arguments;
  placed.insert(placed.end(), {"--origin", "49.005306,8.4374089"});
  const ProcessResult result = scene_from(placed);
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_GE(told().at("points_on_routes").get<double>(), 0.97 * told().at("points").get<double>());
  EXPECT_GE(told().at("vehicles"), 57);
  EXPECT_EQ(told().at("lanelets").at("junctions"), 1);
  EXPECT_NE(result.output.find("left out: signals as recorded"), std::string::npos);
  // and with its signals
  placed.insert(placed.end(), {"--force", "--signals", (data / "signals.csv").string()});
  EXPECT_NE(scene_from(placed).errors.find("--signal-map go together"), std::string::npos);
  placed.insert(placed.end(), {"--signal-map", (data / "k733_map.kml").string()});
  const ProcessResult signalled = scene_from(placed);
  ASSERT_TRUE(signalled.ok()) << signalled.errors;
  EXPECT_EQ(told().at("lanelets").at("signals").at("links_without_a_group"), 0);
  EXPECT_GT(told().at("lanelets").at("signals").at("phases"), 50);
}

TEST_F(SceneFrom, RefusesAMapThatIsntThePlaces) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& why) {
    const ProcessResult result = scene_from(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(why), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_FALSE(fs::exists(folder_ / "out" / "scene.json"));
  };
  const std::string far = recording(40);
  refused({far, "--map", net(), "-o", out()}, "expected 95 %");
  refused({far, "--map", "place.osm", "-o", out()}, "place.osm: can't be read as a Lanelet2 map");
  refused({far, "--map", lanelets(), "-o", out()}, "expected 95 %");
  refused({far, "--map", "place.xodr", "-o", out()}, "a Lanelet2 map NAME.osm");
  refused({far, "-o", out(), "--at", "500"}, "expected a time from 0 to 12.0");
  refused({far, "-o", out(), "--box", "car=4"}, "expected TYPE=LENGTHxWIDTH");
}

}  // namespace
}  // namespace sumogamma
