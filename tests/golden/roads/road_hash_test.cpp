// The exact bits of short runs on roads, by the program and SUMO as users run them. They change
// when the rules of the road do: a refactoring leaves them, a commit that changes behaviour says
// why and puts the new ones in, from the failure's text. Networks, demand and insertion are SUMO's,
// so the bits belong to the version of SUMO that Debian 12 has.
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/hash.h"
#include "support/coupling_scenario.h"
#include "support/recorded_bits.h"

namespace sumogamma {
namespace {

const char* const kSumoVersion = "Version 1.15.0";
const char* const kDuration = "60";  // [s]

/// What the program prints; fails the test where it doesn't end well.
std::string program(const std::vector<std::string>& arguments) {
  ProcessRequest request;
  request.arguments = {SUMOGAMMA_PROGRAM};
  request.arguments.insert(request.arguments.end(), arguments.begin(), arguments.end());
  request.time_limit = 600.0;
  const ProcessResult result = run_process(request);
  EXPECT_EQ(result.exit_code, 0) << describe_end(result, request.time_limit) << "\n"
                                 << result.errors;
  return result.output;
}

/// Runs a scenario into the folder's "out" and returns its state hash.
std::string state_hash(const std::string& scenario, const TemporaryFolder& folder) {
  program({"run", scenario, "-o", folder.file("out"), "--duration", kDuration, "--seed", "1",
           "--threads", "2", "--quiet", "--log", "error"});
  const auto results = nlohmann::json::parse(folder.read("out/results.json"), nullptr, false);
  return results.is_object() ? results.value("state_hash", "") : "no results.json";
}

struct Golden {
  const char* name;
  const char* state;         ///< results.json's state_hash
  const char* network = "";  ///< of what the import makes: network and demand
};
std::ostream& operator<<(std::ostream& out, const Golden& golden) { return out << golden.name; }
std::string name_of(const ::testing::TestParamInfo<Golden>& info) { return info.param.name; }

class GoldenRoads : public ::testing::TestWithParam<Golden> {
 protected:
  void SetUp() override {
    if (!test::computes_as_recorded()) GTEST_SKIP() << test::kOtherLibrary;
    const std::string version = program({"version"});
    if (version.find(kSumoVersion) == std::string::npos)
      GTEST_SKIP() << "the recorded bits are SUMO's " << kSumoVersion
                   << ", here there is another:\n"
                   << version;
  }
};

class GoldenScenarios : public GoldenRoads {};
TEST_P(GoldenScenarios, HaveTheRecordedBits) {
  const std::string name = GetParam().name;
  const TemporaryFolder folder;
  EXPECT_EQ(
      state_hash(SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/" + name + "/" + name + ".sumocfg", folder),
      GetParam().state);
}

// one or two rules of the road each
INSTANTIATE_TEST_SUITE_P(Scenario, GoldenScenarios,
                         ::testing::Values(Golden{"all_way_stop", "926ed16f8e176f20"},
                                           Golden{"bicycle_overtaken", "5aed0e2f017b4408"},
                                           Golden{"bus_stop", "4d5d6094cf09f9d3"},
                                           Golden{"lane_drop", "814d3cb416a9c423"},
                                           Golden{"mid_block", "433668bdee3432cd"},
                                           Golden{"mixed_queue", "0bb1a509367b9201"},
                                           Golden{"roundabout", "2c9c3c742582e57d"},
                                           Golden{"zebra", "fdfb1557c8580497"}),
                         name_of);

class GoldenMaps : public GoldenRoads {};
TEST_P(GoldenMaps, HaveTheRecordedBits) {
  const TemporaryFolder folder;
  const std::string map = SUMOGAMMA_SOURCE_DIR "/osm_maps/" + std::string(GetParam().name);
  program({"import", map + ".osm.pbf", "-o", folder.file("scenario"), "--agents", "100",
           "--duration", kDuration, "--quiet"});
  std::uint64_t network = kFnvBasis;
  for (const char* file : {"scenario/net.net.xml", "scenario/demand.rou.xml"})
    for (const char byte : folder.read(file))
      network = fnv1a(network, static_cast<unsigned char>(byte));
  EXPECT_EQ(hash_text(network), GetParam().network)
      << "the import makes another network or demand, so the traffic is another one too";
  EXPECT_EQ(state_hash(folder.file("scenario"), folder), GetParam().state);
}

INSTANTIATE_TEST_SUITE_P(
    Map, GoldenMaps,
    ::testing::Values(Golden{"fujisawa", "ae92cd79a4e2eb7b", "50ec09f8af82421c"},
                      Golden{"monaco", "60a682daca2f34b5", "d5e3ef5dc5ccdd0b"}),
    name_of);

}  // namespace
}  // namespace sumogamma
