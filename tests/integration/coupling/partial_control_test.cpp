// Part of the traffic is GAMMA's, the rest SUMO's: neither drives into the other, and who leaves a
// place or a time is handed back. Every test runs under both back ends.
//
//                 N
//                 |
//   W ====wc==== C ====ce==== E     wc: 3 lanes, the leftmost leads to N alone
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "sumo/sumo_process.h"
#include "support/coupling_scenario.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

using nlohmann::json;

const std::string kTypes =
    "<vType id='car' vClass='passenger'/><vType id='bike' vClass='bicycle'/>"
    "<vType id='ped' vClass='pedestrian'/>";

class PartialControl : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    testing::PlainNet net;
    net.nodes =
        "<node id='W' x='0' y='0'/><node id='C' x='500' y='0' type='priority'/>"
        "<node id='E' x='900' y='0'/><node id='N' x='500' y='300'/>";
    net.edges =
        "<edge id='wc' from='W' to='C' numLanes='3' speed='13.9' sidewalkWidth='2'/>"
        "<edge id='ce' from='C' to='E' numLanes='2' speed='13.9' sidewalkWidth='2'/>"
        "<edge id='cn' from='C' to='N' numLanes='1' speed='13.9' sidewalkWidth='2'/>";
    net.options = {"--walkingareas", "true"};
    testing::write_plain_net(net, folder_.file("net.net.xml"));
  }

  ProcessResult start(const std::string& demand, const std::vector<std::string>& options) {
    write_user_scenario(folder_, kTypes + demand,
                        "<poly id='middle' shape='150,-20 350,-20 350,20 150,20'/>");
    std::filesystem::remove_all(folder_.file("out"));
    ProcessRequest request;
    request.arguments = {SUMOGAMMA_PROGRAM,
                         "run",
                         folder_.file("s.sumocfg"),
                         "-o",
                         folder_.file("out"),
                         "--step",
                         "0.1",
                         "--duration",
                         "200",
                         "--quiet",
                         "--backend",
                         GetParam()};
    request.arguments.insert(request.arguments.end(), options.begin(), options.end());
    return run_process(request);
  }
  json run(const std::string& demand, const std::vector<std::string>& options) {
    const ProcessResult result = start(demand, options);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const json results = json::parse(folder_.read("out/results.json"));
    EXPECT_EQ(results["agents"]["inserted"], results["agents"]["arrived"]) << results["agents"];
    EXPECT_EQ(results["collisions"]["unique_pairs"], 0) << results["collisions"];
    EXPECT_EQ(results["flow"]["stuck_agents"], 0) << results["flow"];
    EXPECT_EQ(results["coupling"]["teleports"], 0);
    return results;
  }
  void expect_refused(const std::vector<std::string>& options, const std::string& word) {
    const ProcessResult result = start(platoon(1), options);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(word), std::string::npos) << result.errors;
  }

  /// Cars straight on, one every 4 s, of two names in turn.
  static std::string platoon(int cars) {
    std::string demand;
    for (int i = 0; i < cars; ++i)
      demand += "<vehicle id='" + std::string(i % 2 == 0 ? "x" : "y") + std::to_string(i) +
                "' type='car' depart='" + std::to_string(4 * i) +
                "' departLane='1' departSpeed='max'><route edges='wc ce'/></vehicle>";
    return demand;
  }

  TemporaryFolder folder_;
};

/// Those for N change over to the left through those who stay, who are the other kind.
std::string weaving() {
  std::string demand;
  for (int i = 0; i < 16; ++i) {
    const std::string number = std::to_string(i);
    demand += "<vehicle id='x" + number + "' type='car' depart='" + std::to_string(2 * i) +
              ".0' departLane='3' departSpeed='max'><route edges='wc ce'/></vehicle>"
              "<vehicle id='y" +
              number + "' type='car' depart='" + std::to_string(2 * i) +
              ".5' departLane='2' departSpeed='max'><route edges='wc cn'/></vehicle>";
  }
  return demand;
}

TEST_P(PartialControl, SumosLaneChangesLeadIntoNobody) {
  for (const char* ours : {"x*", "y*"}) {
    SCOPED_TRACE(ours);
    const json results = run(weaving(), {"--control", ours});
    EXPECT_EQ(results["agents"]["controlled_peak"].get<int>() > 0, true);
  }
}

TEST_P(PartialControl, SumosVehiclesAreInsertedWhereThereIsRoom) {
  const std::string demand =
      "<vehicle id='x' type='car' depart='0' departLane='1' departPos='20'><route edges='wc ce'/>"
      "<stop lane='wc_1' endPos='40' duration='40'/></vehicle>"
      "<vehicle id='y' type='car' depart='15' departLane='1' departPos='40' departSpeed='0'>"
      "<route edges='wc ce'/></vehicle>";
  // at its stop SUMO has it on its lane; it is a ghost before and after
  for (const char* depart : {"15", "44"}) {
    std::string text = demand;
    text.replace(text.find("'15'"), 4, "'" + std::string(depart) + "'");
    run(text, {"--control", "x"});
  }
  std::string queue;
  for (int i = 0; i < 6; ++i)
    queue += "<vehicle id='x" + std::to_string(i) + "' type='bike' depart='" +
             std::to_string(3 * i) + "' departLane='1'><route edges='wc ce'/></vehicle>";
  const json results =
      run(queue +
              "<vehicle id='y' type='car' depart='20' departLane='1' departPos='30' "
              "departSpeed='max'><route edges='wc ce'/></vehicle>",
          {"--control", "x*"});
  EXPECT_GE(results["agents"]["insertions_delayed"], 0);
}

TEST_P(PartialControl, WhoLeavesARegionIsHandedBackWithoutAJump) {
  for (const std::vector<std::string>& where : {std::vector<std::string>{"--region=150,-20,350,20"},
                                                {"--region=150,-20,350,-20,350,20,150,20"},
                                                {"--take", "area = \"#middle\""}}) {
    SCOPED_TRACE(where.back());
    const json results = run(platoon(10), where);
    const json& agents = results["agents"];
    EXPECT_EQ(agents["taken_over"], 10);
    EXPECT_EQ(agents["handed_back"], 10);
    const json& back = results["coupling"]["hand_back"];
    EXPECT_EQ(back["count"], 10);
    EXPECT_LE(back["position_m"]["max"], 0.05) << back;
    EXPECT_LE(back["heading_rad"]["max"], 0.03) << back;
    EXPECT_LE(back["acceleration"]["max"], 4.6) << back;
    EXPECT_EQ(results["coupling"]["emergency_stops"], 0);
  }
}

TEST_P(PartialControl, ACircleFollowsAnAgent) {
  const json results = run(platoon(8), {"--take", "around = \"y3\", radius = 60"});
  EXPECT_GT(results["agents"]["taken_over"], 2);
  EXPECT_LT(results["agents"]["controlled_peak"], 8);
}

TEST_P(PartialControl, NoMoreAreAliveThanAskedForWhoeverDrives) {
  for (const std::vector<std::string>& who :
       {std::vector<std::string>{"--control", "all"}, {"--region=-50,-50,950,350"}}) {
    std::vector<std::string> options = {"--agents", "5"};
    options.insert(options.end(), who.begin(), who.end());
    EXPECT_LE(run(platoon(10), options)["agents"]["controlled_peak"], 6) << who.back();
  }
}

TEST_P(PartialControl, ATimeOrAShare) {
  const json timed = run(platoon(8), {"--take", "from = 20, to = 30"});
  EXPECT_GT(timed["agents"]["taken_over"], 0);
  EXPECT_EQ(timed["agents"]["taken_over"], timed["agents"]["handed_back"]);
  const json half = run(platoon(24), {"--control", "50%"});
  const double driven = half["agents"]["controlled_mean"];
  const double all = run(platoon(24), {"--control", "all"})["agents"]["controlled_mean"];
  EXPECT_GT(driven, 0.25 * all);
  EXPECT_LT(driven, 0.75 * all);
}

TEST_P(PartialControl, PeopleStay) {
  std::string demand;
  for (int i = 0; i < 3; ++i)
    demand += "<person id='p" + std::to_string(i) + "' type='ped' depart='0' departPos='" +
              std::to_string(100 + 10 * i) + "'><walk edges='wc' arrivalPos='260'/></person>";
  const json results = run(demand, {"--region=130,-20,180,20"});
  EXPECT_EQ(results["agents"]["taken_over"], 3);
  EXPECT_EQ(results["agents"]["handed_back"], 0);
  EXPECT_EQ(results["agents"]["kept_on_foot"], 3);
}

// SUMO's people see no ghost and walk around none
TEST_P(PartialControl, WhoIsHeldOnFootWalksAroundAsOurs) {
  testing::PlainNet net;
  net.nodes = "<node id='A' x='0' y='0'/><node id='B' x='300' y='0'/>";
  net.edges = "<edge id='wc' from='A' to='B' numLanes='1' speed='13.9' width='2.8'/>";
  testing::write_plain_net(net, folder_.file("net.net.xml"));
  const json results = run(
      "<vType id='lorry' vClass='truck'/>"
      "<vehicle id='y' type='lorry' depart='0'><route edges='wc'/>"
      "<stop lane='wc_0' endPos='150' duration='55'/></vehicle>"
      "<vehicle id='x' type='lorry' depart='3'><route edges='wc'/></vehicle>"
      "<person id='p' type='ped' depart='20' departPos='110'><walk edges='wc' arrivalPos='200'/>"
      "</person>",
      {"--control", "x"});
  EXPECT_EQ(results["agents"]["taken_over"], 1);
  EXPECT_EQ(results["agents"]["kept_on_foot"], 0) << "no rule gave anybody up";
}

TEST_P(PartialControl, RulesThatCantBeMeantAreRefused) {
  expect_refused({"--control", "karr"}, "'car'");
  expect_refused({"--control", "q*"}, "q*");
  expect_refused({"--control", "car,120%"}, "0% to 100%");
  expect_refused({"--control", "all,car"}, "stands alone");
  expect_refused({"--region=1,2,3,4,5"}, "--region");
  expect_refused({"--take", "who = 3"}, "who");
  expect_refused({"--take", "colour = \"red\""}, "unknown key");
  expect_refused({"--take", "around = \"x0\""}, "radius");
  expect_refused({"--take", "around = \"nobody\", radius = 5"}, "nobody");
  expect_refused({"--take", "from = 9, to = 3"}, "before");
  expect_refused({"--take", "area = \"#edge\""}, "middle");
}

// SUMO's own Python client asks for a vehicle at 5 s and gives it back at 15 s
TEST(PartialControlCalled, AnotherClientTakesAndReleases) {
  const char* home = std::getenv("SUMO_HOME");
  const std::string tools = std::string(home != nullptr ? home : "/usr/share/sumo") + "/tools";
  if (!std::filesystem::exists(tools + "/traci")) GTEST_SKIP() << "no TraCI client in " << tools;
  TemporaryFolder folder;
  testing::PlainNet net;
  net.nodes = "<node id='A' x='0' y='0'/><node id='B' x='900' y='0'/>";
  net.edges = "<edge id='ab' from='A' to='B' numLanes='1' speed='13.9'/>";
  testing::write_plain_net(net, folder.file("net.net.xml"));
  write_user_scenario(folder,
                      kTypes +
                          "<vehicle id='x' type='car' depart='0' departSpeed='max'>"
                          "<route edges='ab'/></vehicle>",
                      "");
  const int port = free_port();
  const std::string script =
      "import sys, time; sys.path.insert(0, '" + tools +
      "')\nimport traci\nfor _ in range(100):\n"
      "  try:\n    traci.init(" +
      std::to_string(port) +
      ", numRetries=0); break\n"
      "  except Exception: time.sleep(0.1)\ntraci.setOrder(2)\nlanes = []\n"
      "while traci.simulation.getTime() < 30:\n  traci.simulationStep()\n"
      "  now = round(traci.simulation.getTime(), 1)\n"
      "  if now in (5.0, 15.0):\n    traci.vehicle.setParameter('x', 'sumo-gamma.control', "
      "'take' if now == 5.0 else 'release')\n"
      "  if now in (4.0, 10.0, 20.0): lanes.append(traci.vehicle.getLaneID('x'))\n"
      "print(lanes)\ntraci.close()\n";
  auto other = std::async(std::launch::async, [&script] {
    ProcessRequest request;
    request.arguments = {"python3", "-c", script};
    return run_process(request);
  });
  ProcessRequest request;
  request.arguments = {SUMOGAMMA_PROGRAM,
                       "run",
                       folder.file("s.sumocfg"),
                       "-o",
                       folder.file("out"),
                       "--step",
                       "0.1",
                       "--duration",
                       "30",
                       "--quiet",
                       "--control",
                       "called",
                       "--num-clients",
                       "2",
                       "--client-order",
                       "1",
                       "--remote-port",
                       std::to_string(port)};
  const ProcessResult ours = run_process(request);
  const ProcessResult theirs = other.get();
  EXPECT_EQ(ours.exit_code, 0) << ours.errors;
  EXPECT_EQ(theirs.exit_code, 0) << theirs.errors;
  EXPECT_EQ(theirs.output, "['ab_0', '', 'ab_0']\n") << "a ghost is on no lane";
  const json results = json::parse(folder.read("out/results.json"));
  EXPECT_EQ(results["agents"]["taken_over"], 1);
  EXPECT_EQ(results["agents"]["handed_back"], 1);
}

INSTANTIATE_TEST_SUITE_P(BackEnd, PartialControl, ::testing::Values("traci", "libsumo"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace sumogamma
