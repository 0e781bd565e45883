// Plans as SUMO means them: stops, parking, rides, trams. Each runs the program on a road of three
// edges, made on the spot, and reads what SUMO itself writes about it.
//
//   A ---ab--- B ---bc--- C ---cd--- D     300 m each; lane 0 a sidewalk, 1 and (but for bc) 2 for
//   vehicles
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "support/coupling_scenario.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

using nlohmann::json;

class Plans : public ::testing::Test {
 protected:
  void SetUp() override {
    testing::PlainNet net;
    net.nodes =
        "<node id='A' x='0' y='0'/><node id='B' x='300' y='0'/><node id='C' x='600' y='0'/>"
        "<node id='D' x='900' y='0'/>";
    net.edges =
        "<edge id='ab' from='A' to='B' numLanes='2' speed='13.9' sidewalkWidth='2'/>"
        "<edge id='bc' from='B' to='C' numLanes='1' speed='13.9' sidewalkWidth='2'/>"
        "<edge id='cd' from='C' to='D' numLanes='2' speed='13.9' sidewalkWidth='2'/>";
    net.options = {"--walkingareas", "true"};
    testing::write_plain_net(net, folder_.file("net.net.xml"));
  }

  /// Runs a scenario; its results. SUMO's trips and stops are in ti.xml and so.xml.
  json run(const std::string& demand, const std::string& additional,
           const std::string& control = "all", const std::string& more_input = "") {
    write_user_scenario(folder_, demand, additional, more_input);
    std::filesystem::remove_all(folder_.file("out"));
    ProcessRequest request;
    request.arguments = {
        SUMOGAMMA_PROGRAM,
        "run",
        folder_.file("s.sumocfg"),
        "-o",
        folder_.file("out"),
        "--step",
        "0.1",
        "--duration",
        "300",
        "--quiet",
        "--control",
        control,
        "--sumo-options",
        "--tripinfo-output " + folder_.file("ti.xml") + " --stop-output " + folder_.file("so.xml")};
    const ProcessResult result = run_process(request);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return json::parse(folder_.read("out/results.json"));
  }
  /// Values of an attribute of SUMO's elements of a name, in order.
  std::vector<std::string> sumos(const char* file, const char* element, const char* attribute) {
    pugi::xml_document document;
    document.load_file(folder_.file(file).c_str());
    std::vector<std::string> values;
    for (const pugi::xpath_node& node :
         document.select_nodes((std::string("//") + element).c_str()))
      values.emplace_back(node.node().attribute(attribute).value());
    return values;
  }
  static void expect_all_arrive(const json& results) {
    EXPECT_EQ(results["agents"]["inserted"], results["agents"]["arrived"]) << results["agents"];
    EXPECT_EQ(results["collisions"]["unique_pairs"], 0) << results["collisions"];
    EXPECT_EQ(results["flow"]["stuck_agents"], 0) << results["flow"];
  }

  TemporaryFolder folder_;
};

const std::string kTypes =
    "<vType id='car' vClass='passenger'/><vType id='bus' vClass='bus'/>"
    "<vType id='ped' vClass='pedestrian'/><vType id='tram' vClass='tram'/>";
const std::string kBusStops =
    "<busStop id='s1' lane='ab_1' startPos='150' endPos='170'/>"
    "<busStop id='s2' lane='bc_1' startPos='150' endPos='170'/>"
    "<busStop id='s3' lane='cd_1' startPos='150' endPos='170'/>";

// also where the lane of the stop leads no further
TEST_F(Plans, ABusIsServedOnEitherLaneShortlyBeforeTheRoadNarrows) {
  for (const std::string lane : {"ab_1", "ab_2"}) {
    SCOPED_TRACE(lane);
    const json results = run(kTypes +
                                 "<vehicle id='b' type='bus' depart='0'><route edges='ab bc cd'/>"
                                 "<stop busStop='s' duration='10'/></vehicle>",
                             "<busStop id='s' lane='" + lane + "' startPos='275' endPos='295'/>");
    expect_all_arrive(results);
    EXPECT_EQ(results["agents"]["stops_served"], 1);
    EXPECT_EQ(sumos("so.xml", "stopinfo", "lane"), std::vector<std::string>{lane});
  }
}

TEST_F(Plans, PeopleBoardRideAlightAndWalkOn) {
  std::string demand = kTypes;
  for (int i = 0; i < 3; ++i)
    demand += "<person id='p" + std::to_string(i) + "' type='ped' depart='0' departPos='" +
              std::to_string(100 + 10 * i) +
              "'><walk edges='ab' busStop='s1'/><ride busStop='s3' lines='7'/>"
              "<walk edges='cd' arrivalPos='220'/></person>";
  demand +=
      "<vehicle id='b' type='bus' line='7' depart='50'><route edges='ab bc cd'/>"
      "<stop busStop='s1' duration='15'/><stop busStop='s3' duration='15'/></vehicle>";
  for (const char* control : {"all", "none"}) {
    const json results = run(demand, kBusStops, control);
    EXPECT_EQ(results["agents"]["by_type"]["pedestrian"]["arrived"], 3) << control;
    EXPECT_EQ(results["agents"]["by_type"]["bus"]["arrived"], 1) << control;
    EXPECT_EQ(sumos("ti.xml", "ride", "vehicle"), (std::vector<std::string>{"b", "b", "b"}));
    EXPECT_EQ(sumos("so.xml", "stopinfo", "loadedPersons"), (std::vector<std::string>{"3", "0"}));
    // riders are no obstacles inside their bus
    EXPECT_EQ(results["collisions"]["by_types"].count("bus-pedestrian"), 0u)
        << results["collisions"];
    if (std::string(control) == "all") expect_all_arrive(results);
  }
}

TEST_F(Plans, WhoRidesFromTheFirstIsNoBodyInItsOwnCar) {
  const json results =
      run(kTypes +
              "<person id='p' depart='0'><ride from='ab' to='cd' lines='c'/>"
              "<walk edges='cd' arrivalPos='200'/></person>"
              "<vehicle id='c' type='car' depart='triggered'><route edges='ab bc cd'/></vehicle>",
          "");
  expect_all_arrive(results);
  EXPECT_EQ(results["agents"]["inserted"], 2);
  EXPECT_EQ(results["rules"]["off_road_s"], 0.0);
}

TEST_F(Plans, UntilIsATimeOfTheClock) {
  const json results =
      run(kTypes +
              "<vehicle id='b' type='bus' depart='0'><route edges='ab bc cd'/>"
              "<stop busStop='s1' until='40'/><stop busStop='s2' until='85' duration='5'/>"
              "<stop lane='cd_2' endPos='100' duration='10'/></vehicle>",
          kBusStops);
  expect_all_arrive(results);
  const std::vector<std::string> ended = sumos("so.xml", "stopinfo", "ended");
  ASSERT_EQ(ended.size(), 3u);
  EXPECT_EQ(ended[0], "40.00");
  EXPECT_EQ(ended[1], "85.00");
  EXPECT_EQ(sumos("so.xml", "stopinfo", "lane")[2], "cd_2");
}

TEST_F(Plans, WhoParksIsOffTheRoad) {
  const std::string area =
      "<parkingArea id='pa' lane='bc_1' startPos='50' endPos='100' roadsideCapacity='5'/>";
  const json results =
      run(kTypes +
              "<route id='r' edges='ab bc cd'/>"
              "<vehicle id='park' type='car' route='r' depart='0'><stop parkingArea='pa' "
              "duration='120'/></vehicle>"
              "<flow id='f' type='car' route='r' begin='5' end='60' period='5'/>",
          area);
  expect_all_arrive(results);
  EXPECT_EQ(results["agents"]["inserted"], 12);
  EXPECT_EQ(sumos("so.xml", "stopinfo", "parking"), (std::vector<std::string>{"1"}));
  EXPECT_LT(results["rules"]["off_road_s"], 1.0);
}

TEST_F(Plans, WhoStartsParkedComesOutOfItsPlace) {
  const json results =
      run(kTypes +
              "<vehicle id='park' type='car' depart='0' departPos='stop'><route edges='bc cd'/>"
              "<stop parkingArea='pa' duration='100'/></vehicle>"
              "<flow id='f' type='car' begin='5' end='90' period='6'>"
              "<route edges='ab bc cd'/></flow>",
          "<parkingArea id='pa' lane='bc_1' startPos='50' endPos='100' roadsideCapacity='5'/>");
  expect_all_arrive(results);
}

TEST_F(Plans, AWalkerStopsAndWalksOnAsOneAgent) {
  const json results =
      run(kTypes +
              "<person id='p' depart='0' departPos='260'><walk from='ab' to='bc' arrivalPos='40'/>"
              "<stop lane='bc_0' endPos='45' duration='20'/><walk edges='bc' "
              "arrivalPos='90'/></person>",
          "");
  expect_all_arrive(results);
  EXPECT_EQ(results["agents"]["inserted"], 1);
}

TEST_F(Plans, CarsQueueBehindATram) {
  const json results =
      run(kTypes +
              "<route id='r' edges='ab bc cd'/>"
              "<flow id='f' type='car' route='r' begin='0' end='60' period='8' departSpeed='max'/>"
              "<vehicle id='t' type='tram' route='r' depart='12'><stop busStop='s2' "
              "duration='20'/></vehicle>",
          kBusStops);
  expect_all_arrive(results);
  EXPECT_EQ(results["agents"]["by_type"]["tram"]["arrived"], 1);
  EXPECT_EQ(results["agents"]["taken_over"], 0) << "whoever is on rails stays SUMO's";
  EXPECT_EQ(results["agents"]["left_to_sumo"]["on rails or water"], 1);
}

TEST_F(Plans, WhoDepartsAtItsStopIsSumosUntilItIsOver) {
  const json results = run(kTypes +
                               "<vehicle id='b' type='bus' depart='0' departPos='stop'>"
                               "<route edges='ab bc cd'/><stop busStop='s1' until='60'/></vehicle>",
                           kBusStops);
  expect_all_arrive(results);
  EXPECT_EQ(results["agents"]["taken_over"], 0);
  EXPECT_EQ(sumos("so.xml", "stopinfo", "ended"), std::vector<std::string>{"60.00"});
}

TEST_F(Plans, VehiclesOfALoadedStateAreThere) {
  const std::string demand =
      kTypes +
      "<vType id='slow' vClass='passenger' maxSpeed='3'/>"
      "<vehicle id='slow' type='slow' depart='0' departLane='1'><route edges='ab bc cd'/></vehicle>"
      "<flow id='f' type='car' begin='20' end='60' period='5' departLane='1'>"
      "<route edges='bc cd'/></flow>";
  run(demand, "");  // writes the files
  ProcessRequest save;
  save.arguments = {"sumo",
                    "-c",
                    folder_.file("s.sumocfg"),
                    "--end",
                    "16",
                    "--step-length",
                    "0.1",
                    "--save-state.times",
                    "15",
                    "--save-state.files",
                    folder_.file("st.xml"),
                    "--no-step-log"};
  ASSERT_TRUE(run_process(save).ok());
  const json results = run(demand, "", "all", "<load-state value='st.xml'/>");
  EXPECT_EQ(results["agents"]["inserted"], 9);
  EXPECT_EQ(results["collisions"]["unique_pairs"], 0) << results["collisions"];
}

/// Two ways from A to D: ab, bd, and, 100 m longer, ab, bc, cd.
class Routes : public Plans {
 protected:
  void SetUp() override {
    testing::PlainNet net;
    net.nodes =
        "<node id='Z' x='-300' y='0'/><node id='A' x='0' y='0'/><node id='B' x='300' y='0'/>"
        "<node id='C' x='600' y='250'/><node id='D' x='900' y='0'/><node id='E' x='1100' y='0'/>";
    net.edges =
        "<edge id='za' from='Z' to='A' numLanes='1' speed='13.9'/>"
        "<edge id='ab' from='A' to='B' numLanes='1' speed='13.9'/>"
        "<edge id='bd' from='B' to='D' numLanes='1' speed='13.9'/>"
        "<edge id='bc' from='B' to='C' numLanes='1' speed='13.9'/>"
        "<edge id='cd' from='C' to='D' numLanes='1' speed='13.9'/>"
        "<edge id='de' from='D' to='E' numLanes='1' speed='13.9'/>";
    testing::write_plain_net(net, folder_.file("net.net.xml"));
  }
  /// Passages of an edge in the run's own trajectories.
  std::size_t on_edge(const std::string& edge) {
    ProcessRequest unzip;
    unzip.arguments = {"gzip", "-dc", folder_.file("out/trajectories.fcd.xml.gz")};
    const std::string text = run_process(unzip).output;
    std::set<std::string> ids;
    std::size_t at = 0;
    while ((at = text.find("lane=\"" + edge + "_", at)) != std::string::npos) {
      const std::size_t begin = text.rfind("id=\"", at) + 4;
      ids.insert(text.substr(begin, text.find('"', begin) - begin));
      ++at;
    }
    return ids.size();
  }
};

const std::string kFlow =
    "<flow id='f' type='car' begin='0' end='50' period='10'><route edges='za ab bd de'/></flow>";

TEST_F(Routes, AClosedEdgeIsGoneRound) {
  const json results = run(kTypes + kFlow,
                           "<rerouter id='r' edges='ab'><interval begin='0' end='1000'>"
                           "<closingReroute id='bd'/></interval></rerouter>");
  expect_all_arrive(results);
  EXPECT_EQ(on_edge("bd"), 0u);
  EXPECT_EQ(on_edge("bc"), 5u);
}

TEST_F(Routes, AReroutersRouteIsTaken) {
  const json results =
      run(kTypes + "<vehicle id='v' type='car' depart='0'><route edges='za ab bd de'/></vehicle>",
          "<route id='round' edges='ab bc cd de'/>"
          "<rerouter id='r' edges='ab'><interval begin='0' end='1000'>"
          "<routeProbReroute id='round' probability='1'/></interval></rerouter>");
  expect_all_arrive(results);
  EXPECT_EQ(on_edge("bc"), 1u);
}

TEST_F(Routes, ReroutingDevicesSeeOurQueues) {
  // a van that crawls on the shorter way: who comes behind it later goes round
  const json results = run(
      kTypes +
          "<vType id='slow' vClass='passenger' maxSpeed='1.5'/>"
          "<vehicle id='s' type='slow' depart='0' departPos='250'><route edges='ab bd'/></vehicle>"
          "<flow id='f' type='car' begin='150' end='200' period='10'>"
          "<param key='has.rerouting.device' value='true'/>"
          "<param key='device.rerouting.period' value='5'/><route edges='za ab bd de'/></flow>",
      "");
  EXPECT_GE(on_edge("bc"), 3u) << results["agents"];
}

TEST_F(Routes, VariableSpeedSignsAreKept) {
  const json results = run(kTypes +
                               "<vehicle id='v' type='car' depart='0' departSpeed='max'>"
                               "<route edges='za ab bd'/></vehicle>",
                           "<variableSpeedSign id='s' lanes='ab_0 bd_0'><step time='5' "
                           "speed='5'/></variableSpeedSign>");
  // 300 m at 13.9 m/s and 900 m at 5: 202 s, not 86
  EXPECT_GT(results["agents"]["by_type"]["car"]["mean_travel_time_s"], 180) << results["agents"];
}

}  // namespace
}  // namespace sumogamma
