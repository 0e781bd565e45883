// What SUMO tells others of agents that we drive: its own FCD output beside ours, of one run.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <utility>

#include "base/subprocess.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

struct Sample {
  double x = 0, y = 0, angle = 0, speed = 0, acceleration = 0;
  bool person = false;
};
using Samples = std::map<std::pair<std::string, long>, Sample>;  // by id and time [ms]

/// Of a file that SUMO or we wrote, gzipped or not.
Samples read_samples(const fs::path& file) {
  std::string text;
  gzFile stream = gzopen(file.c_str(), "rb");
  if (stream == nullptr) throw std::runtime_error(file.string() + " can't be read");
  char buffer[1 << 16];
  for (int got = 0; (got = gzread(stream, buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(got));
  gzclose(stream);
  pugi::xml_document document;
  if (!document.load_string(text.c_str())) throw std::runtime_error(file.string() + " is no XML");
  Samples samples;
  for (const pugi::xml_node step : document.document_element().children()) {
    const long time = std::lround(1000.0 * step.attribute("time").as_double());
    for (const pugi::xml_node agent : step.children())
      samples[{agent.attribute("id").value(), time}] = {agent.attribute("x").as_double(),
                                                        agent.attribute("y").as_double(),
                                                        agent.attribute("angle").as_double(),
                                                        agent.attribute("speed").as_double(),
                                                        agent.attribute("acceleration").as_double(),
                                                        std::string(agent.name()) == "person"};
  }
  return samples;
}

/// A run of a scenario for 40 s with this back end; both files, every step.
std::pair<Samples, Samples> run(const std::string& scenario, const std::string& backend) {
  const TemporaryFolder folder;
  ProcessRequest request;
  request.arguments = {SUMOGAMMA_PROGRAM,
                       "run",
                       scenario,
                       "-o",
                       folder.file("out"),
                       "--quiet",
                       "--backend",
                       backend,
                       "--duration",
                       "40",
                       "--step",
                       "0.05",
                       "--trajectory-period",
                       "0",
                       "--sumo-options",
                       "--fcd-output " + folder.file("sumo.xml") + " --fcd-output.acceleration"};
  request.time_limit = 300.0;
  const ProcessResult result = run_process(request);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return {read_samples(folder.file("out/trajectories.fcd.xml.gz")),
          read_samples(folder.file("sumo.xml"))};
}

void expect_the_same(const std::string& scenario, const std::string& backend) {
  const auto [ours, sumos] = run(scenario, backend);
  ASSERT_GT(ours.size(), 500u) << "nothing to compare";
  constexpr double kRounded = 0.0101;  // two decimals
  constexpr double kStep = 0.05;
  std::size_t fast = 0;
  double speed_error = 0, moved_error = 0, gained_error = 0;
  for (const auto& [key, mine] : ours) {
    const auto& [id, time] = key;
    const auto found = sumos.find(key);
    ASSERT_NE(found, sumos.end()) << id << " at " << time << " ms isn't in SUMO's output";
    const Sample& theirs = found->second;
    ASSERT_NEAR(mine.x, theirs.x, kRounded) << id << " at " << time << " ms";
    ASSERT_NEAR(mine.y, theirs.y, kRounded) << id << " at " << time << " ms";
    ASSERT_LT(std::abs(std::remainder(mine.angle - theirs.angle, 360.0)), kRounded) << id;
    const auto before = ours.find({id, time - 50});
    // SUMO takes it for a person's speed how it came to the place where it starts
    if (mine.person && before == ours.end()) continue;
    speed_error = std::max(speed_error, std::abs(mine.speed - theirs.speed));
    EXPECT_NEAR(mine.speed, theirs.speed, kRounded) << id << " at " << time << " ms";
    fast += mine.speed > 8.0 ? 1 : 0;
    if (before == ours.end()) continue;
    const double moved = std::hypot(mine.x - before->second.x, mine.y - before->second.y) / kStep;
    moved_error = std::max(moved_error, std::abs(moved - theirs.speed));
    EXPECT_NEAR(moved, theirs.speed, 4.0 * kRounded / kStep) << id << " at " << time << " ms";
    if (mine.person) continue;
    const double gained = (mine.speed - before->second.speed) / kStep;
    gained_error = std::max(gained_error, std::abs(gained - theirs.acceleration));
    EXPECT_NEAR(gained, theirs.acceleration, 2.0 * kRounded / kStep) << id << " at " << time;
  }
  ::testing::Test::RecordProperty("greatest_speed_error_mm_s",
                                  static_cast<int>(1000.0 * speed_error));
  ::testing::Test::RecordProperty("greatest_acceleration_error_mm_s2",
                                  static_cast<int>(1000.0 * gained_error));
  ::testing::Test::RecordProperty("greatest_error_of_displacement_mm_s",
                                  static_cast<int>(1000.0 * moved_error));
  EXPECT_GT(fast, 100u) << "nobody drives";
}

class Velocities : public ::testing::TestWithParam<const char*> {};

// a car that starts on a lane of 5 m/s goes on to ones of 14: SUMO by itself tells 5 for the rest
// of its way; a van turns; one waits for its place, and jumps to it
TEST_P(Velocities, OnFastRoadsBehindASlowOne) {
  const TemporaryFolder folder;
  folder.write("nodes.xml", R"(<nodes><node id="a" x="0" y="0"/><node id="b" x="60" y="0"/>
<node id="c" x="300" y="0"/><node id="d" x="300" y="200"/><node id="e" x="600" y="0"/></nodes>)");
  folder.write("edges.xml", R"(<edges><edge id="ab" from="a" to="b" numLanes="1" speed="5"/>
<edge id="bc" from="b" to="c" numLanes="2" speed="14"/><edge id="cd" from="c" to="d" speed="14"/>
<edge id="ce" from="c" to="e" numLanes="2" speed="14"/></edges>)");
  ProcessRequest request;
  request.arguments = {"netconvert",
                       "--node-files",
                       folder.file("nodes.xml"),
                       "--edge-files",
                       folder.file("edges.xml"),
                       "--sidewalks.guess",
                       "--sidewalks.guess.max-speed",
                       "15",
                       "-o",
                       folder.file("net.net.xml")};
  ASSERT_TRUE(run_process(request).ok());
  folder.write("routes.rou.xml", R"(<routes>
  <vType id="car" vClass="passenger" speedDev="0"/><vType id="lame" vClass="delivery" maxSpeed="12"/>
  <vType id="bus" vClass="bus"/><vType id="rider" vClass="bicycle"/>
  <flow id="car" type="car" begin="0" period="4" number="5"><route edges="ab bc ce"/></flow>
  <flow id="lame" type="lame" begin="1" period="6" number="3"><route edges="ab bc cd"/></flow>
  <vehicle id="bus" type="bus" depart="3"><route edges="bc cd"/></vehicle>
  <vehicle id="rider" type="rider" depart="5"><route edges="ab bc ce"/></vehicle>
  <person id="walker" depart="1"><walk edges="ab bc" arrivalPos="40"/></person>
</routes>)");
  folder.write("s.sumocfg", R"(<configuration><input><net-file value="net.net.xml"/>
<route-files value="routes.rou.xml"/></input></configuration>)");
  expect_the_same(folder.file("s.sumocfg"), GetParam());
}

TEST_P(Velocities, InMixedTraffic) {
  expect_the_same(SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/mixed_queue/mixed_queue.sumocfg",
                  GetParam());
}

TEST_P(Velocities, OnARealMap) {
  const fs::path map = fs::path(SUMOGAMMA_SHARED_DIR) / "data/maps/meskel_square.osm";
  if (!fs::exists(map)) GTEST_SKIP() << map << " isn't here";
  const TemporaryFolder folder;
  ProcessRequest request;
  request.arguments = {SUMOGAMMA_PROGRAM,  "import",   map,  "-o",
                       folder.file("map"), "--agents", "60", "--quiet"};
  request.time_limit = 300.0;
  ASSERT_TRUE(run_process(request).ok());
  expect_the_same(folder.file("map"), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Coupling, Velocities, ::testing::Values("traci", "libsumo"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace sumogamma
