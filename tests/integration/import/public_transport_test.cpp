// From a map with bus lines to riders that have arrived, driven by GAMMA and by SUMO alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "base/subprocess.h"
#include "io/config.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

const fs::path kFixtures = fs::path(SUMOGAMMA_SOURCE_DIR) / "tests/support/osm";

class PublicTransportTest : public ::testing::Test {
 protected:
  static ProcessResult program(std::vector<std::string> arguments) {
    ProcessRequest request;
    request.arguments = {SUMOGAMMA_PROGRAM};
    request.arguments.insert(request.arguments.end(), arguments.begin(), arguments.end());
    request.time_limit = 300.0;
    return run_process(request);
  }
  ProcessResult import(const std::string& map, const std::string& demand) {
    folder_.write("demand.toml", demand);
    return program({"import", (kFixtures / map).string(), "-o", folder_.file("out"), "--duration",
                    "600", "--demand", folder_.file("demand.toml"), "--quiet"});
  }
  /// Results of a run whose trips and stops, as SUMO writes them, are in ti.xml and so.xml.
  json run(const std::string& control) {
    fs::remove_all(folder_.file("run"));
    const ProcessResult result =
        program({"run", folder_.file("out"), "-o", folder_.file("run"), "--control", control,
                 "--step", "0.1", "--duration", "600", "--quiet", "--sumo-options",
                 "--tripinfo-output " + folder_.file("ti.xml") + " --stop-output " +
                     folder_.file("so.xml")});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return json::parse(folder_.read("run/results.json"));
  }
  /// People who got off a bus and walked on to the end of their trips.
  int riders_taken() {
    pugi::xml_document document;
    document.load_file(folder_.file("ti.xml").c_str());
    int count = 0;
    for (const pugi::xml_node person : document.document_element().children("personinfo"))
      count += person.child("ride").attribute("arrival").as_double(-1) > 0 &&
               std::string_view(person.last_child().name()) == "walk";
    return count;
  }
  json imported() { return json::parse(folder_.read("out/import.json")); }
  TemporaryFolder folder_;
};

constexpr const char* kLines =
    "[demand]\nagents = 10\npublic_transport = true\nheadway = 120\nriders = 300\n"
    "[demand.shares]\ncar = 1.0\n";

class RiddenLines : public PublicTransportTest,
                    public ::testing::WithParamInterface<const char*> {};

TEST_P(RiddenLines, RidersAreTakenToTheirStopsByEither) {
  const std::string side = GetParam();
  const ProcessResult result = import("bus_lines_" + side + ".osm", kLines);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("public transport: 3 of 5 lines on roads"));
  EXPECT_THAT(result.output, HasSubstr("4 (relation/1004)"));
  EXPECT_THAT(result.output, HasSubstr("not driven: 1 tram"));
  const json demand = imported()["demand"]["public_transport"];
  EXPECT_EQ(demand["parts_of_lines"], 5);
  EXPECT_GT(demand["buses"], 12);  // the map's headway of line 1, 120 s of the others
  EXPECT_GT(demand["riders"], 20);
  EXPECT_EQ(demand["problem"], "");

  for (const char* const control : {"none", "all"}) {
    const json results = run(control);
    if (std::string(control) == "all") {
      EXPECT_EQ(results["collisions"]["deep_pairs"], 0);
    }
    EXPECT_GE(riders_taken(), 5) << control;
    pugi::xml_document stops;
    stops.load_file(folder_.file("so.xml").c_str());
    int served = 0;
    for (const pugi::xml_node stop : stops.document_element().children("stopinfo"))
      served += std::string(stop.attribute("busStop").value()) != "" ? 1 : 0;
    EXPECT_GT(served, 15) << control;
    EXPECT_GT(results["agents"]["by_type"]["bus"]["arrived"], 3) << control;
  }
}

INSTANTIATE_TEST_SUITE_P(Sides, RiddenLines, ::testing::Values("right", "left"),
                         [](const auto& row) { return std::string(row.param); });

TEST_F(PublicTransportTest, SumoHasNothingToSayOfRoutesStopsAndRiders) {
  ASSERT_EQ(import("bus_lines_right.osm", kLines).exit_code, 0);
  ProcessRequest sumo;
  sumo.arguments = {"sumo", "-c", folder_.file("out/scenario.sumocfg"), "--step-length", "0.5"};
  const ProcessResult result = run_process(sumo);
  EXPECT_EQ(result.exit_code, 0);
  for (const char* const word : {"Error", "erson", "route", "stop", "bus."})
    EXPECT_THAT(result.errors, Not(HasSubstr(word)));
}

TEST_F(PublicTransportTest, IsDrawnAnewOnTheScenarioAndTakenOutAgain) {
  ASSERT_EQ(import("bus_lines_right.osm", "[demand]\nagents = 10\n").exit_code, 0);
  const std::string config = folder_.read("out/scenario.sumocfg"),
                    without = folder_.read("out/demand.rou.xml");
  EXPECT_THAT(config, Not(HasSubstr("public_transport")));
  EXPECT_THAT(without, Not(HasSubstr("busStop")));
  ASSERT_TRUE(fs::exists(folder_.file("out/public_transport.add.xml")));

  const ProcessResult drawn =
      program({"demand", folder_.file("out"), "--set", "demand.public_transport=true", "--quiet"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  EXPECT_THAT(folder_.read("out/scenario.sumocfg"), HasSubstr(",public_transport.add.xml"));
  EXPECT_THAT(folder_.read("out/demand.rou.xml"), HasSubstr("<stop busStop=\"n21\""));
  EXPECT_THAT(folder_.read("out/demand.rou.xml"), HasSubstr("lines=\"2_A:"));
  EXPECT_GT(imported()["demand"]["public_transport"]["riders"], 0);

  ASSERT_EQ(program({"demand", folder_.file("out"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(folder_.read("out/demand.rou.xml"), without);
  EXPECT_THAT(folder_.read("out/scenario.sumocfg"), Not(HasSubstr("public_transport")));
}

TEST_F(PublicTransportTest, SaysWhatIsMissing) {
  const ProcessResult none = import("zebra_right.osm", "[demand]\npublic_transport = true\n");
  EXPECT_EQ(none.exit_code, 0) << none.errors;
  EXPECT_THAT(none.output, HasSubstr("the map has no line"));
  EXPECT_THAT(std::string(imported()["demand"]["public_transport"]["problem"]),
              HasSubstr("no line"));
  fs::remove_all(folder_.file("out"));
  const auto refused = [&](const std::string& demand, const std::string& words) {
    const ProcessResult result = import("bus_lines_right.osm", demand);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.errors, HasSubstr(words));
    EXPECT_FALSE(fs::exists(folder_.file("out")));
  };
  refused("[demand]\nriders = 100\n", "needs public_transport = true");
  refused("[demand]\npublic_transport = true\nheadways = 300\n",
          "the nearest known one is 'demand.headway'");
  refused("[demand]\npublic_transport = true\nheadway = 0\n", "demand.headway");
  refused("[demand]\npublic_transport = 1\n", "true or false");
}

}  // namespace
}  // namespace sumogamma
