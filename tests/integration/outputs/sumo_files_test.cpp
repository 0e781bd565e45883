// SUMO's outputs as sumo-gamma writes them, beside SUMO's own: on SUMO's own driving, then where
// GAMMA drives the same demand.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDemand = R"(
  <vType id='car' vClass='passenger' speedDev='0'/><vType id='bus' vClass='bus'/>
  <vType id='bike' vClass='bicycle'/>
  <person id='rider' depart='0' departPos='165'><walk edges='ab' busStop='s'/>
    <ride busStop='t' lines='ANY'/><walk edges='cd' arrivalPos='200'/></person>
  <flow id='f' type='car' begin='0' end='90' period='4' departSpeed='max'><route edges='ab bc cd'/></flow>
  <flow id='g' type='bike' begin='0' end='60' period='15'><route edges='ab bc'/></flow>
  <vehicle id='b' type='bus' depart='5'><route edges='ab bc cd'/>
    <stop busStop='s' duration='15'/><stop busStop='t' duration='5'/></vehicle>)";

constexpr const char* kAdditional = R"(
  <busStop id='s' lane='ab_1' startPos='170' endPos='190'/>
  <busStop id='t' lane='cd_1' startPos='120' endPos='140'/>
  <e1Detector id='e1' lane='bc_1' pos='100' freq='60' file='e1.xml'/>
  <inductionLoop id='e1b' lane='bc_1' pos='-20' period='60' file='e1.xml' vTypes='car'/>
  <instantInductionLoop id='ie' lane='bc_1' pos='100' file='ie.xml'/>
  <laneAreaDetector id='e2' lane='ab_1' pos='20' endPos='-1' freq='60' file='e2.xml'/>
  <entryExitDetector id='e3' freq='60' file='e3.xml'>
    <detEntry lane='ab_1' pos='10'/><detEntry lane='ab_2' pos='10'/>
    <detExit lane='bc_1' pos='250'/><detExit lane='bc_2' pos='250'/></entryExitDetector>
  <edgeData id='ed' freq='60' file='ed.xml.gz'/>
  <edgeData id='busses' file='ed_bus.xml' vTypes='bus' excludeEmpty='true' minSamples='5'/>
  <laneData id='ld' begin='30' end='90' freq='30' file='ld.xml' excludeEmpty='true'/>)";

std::string content_of(const fs::path& file) {
  gzFile stream = gzopen(file.c_str(), "rb");
  if (stream == nullptr) return {};
  std::string text;
  char buffer[1 << 16];
  for (int got = 0; (got = gzread(stream, buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(got));
  gzclose(stream);
  return text;
}

/// All elements of a file, named by their way from the root with their ids and begins.
using Attributes = std::map<std::string, std::string>;
using Elements = std::map<std::string, Attributes>;

void append_elements(const pugi::xml_node& parent, const std::string& way, Elements& elements) {
  for (const pugi::xml_node node : parent.children()) {
    if (node.type() != pugi::node_element) continue;
    std::string name = way + "/" + node.name();
    for (const char* key : {"id", "begin"})
      if (node.attribute(key)) name += "[" + std::string(node.attribute(key).value()) + "]";
    for (const pugi::xml_attribute attribute : node.attributes())
      elements[name][attribute.name()] = attribute.value();
    append_elements(node, name, elements);
  }
}

class SumoFilesTest : public ::testing::Test {
 protected:
  SumoFilesTest() {
    folder_.write("nodes.xml", R"(<nodes><node id="a" x="0" y="0"/><node id="b" x="300" y="0"
 type="traffic_light"/><node id="c" x="600" y="0"/><node id="d" x="900" y="0"/>
 <node id="n" x="300" y="200"/><node id="s" x="300" y="-200"/></nodes>)");
    folder_.write("edges.xml", R"(<edges><edge id="ab" from="a" to="b" numLanes="2" speed="13.8"/>
<edge id="bc" from="b" to="c" numLanes="2" speed="13.8"/><edge id="cd" from="c" to="d" numLanes="2"
 speed="13.8"/><edge id="nb" from="n" to="b" speed="13.8"/><edge id="bs" from="b" to="s"
 speed="13.8"/></edges>)");
    const ProcessResult made =
        run_words({"netconvert", "--node-files", folder_.file("nodes.xml"), "--edge-files",
                   folder_.file("edges.xml"), "--sidewalks.guess", "--crossings.guess", "-o",
                   folder_.file("net.net.xml")});
    if (!made.ok()) throw std::runtime_error(made.errors);
    write_user_scenario(folder_, kDemand, kAdditional);
  }

  static ProcessResult run_words(std::vector<std::string> words) {
    ProcessRequest request;
    request.arguments = std::move(words);
    request.time_limit = 300.0;
    return run_process(request);
  }

  ProcessResult run(const std::string& control, const std::string& more = "",
                    const std::string& backend = "traci") {
    std::string options = more;
    for (const char* name :
         {"tripinfo", "statistic", "summary", "person-summary", "fcd", "edgedata", "stop"})
      options += " --" + std::string(name) + "-output " + folder_.file(std::string(name) + ".xml");
    return run_words({SUMOGAMMA_PROGRAM, "run", folder_.file("s.sumocfg"), "-o",
                      folder_.file("out"), "--force", "--quiet", "--backend", backend, "--step",
                      "0.1", "--duration", "300", "--control", control, "--sumo-options",
                      options + " --time-to-teleport -1 --collision.action none"});
  }

  /// The elements of a file; none where it isn't there or no XML.
  Elements elements(const std::string& file) const {
    pugi::xml_document document;
    Elements found;
    if (!document.load_string(content_of(folder_.file(file)).c_str())) return found;
    append_elements(document.document_element(), "", found);
    return found;
  }

  std::map<std::string, Elements> all_files() const {
    std::map<std::string, Elements> files;
    for (const char* name :
         {"e1.xml", "ie.xml", "e2.xml", "e3.xml", "ed.xml.gz", "ed_bus.xml", "ld.xml",
          "edgedata.xml", "tripinfo.xml", "statistic.xml", "summary.xml", "person-summary.xml"})
      files[name] = elements(name);
    return files;
  }

  std::vector<std::string> hidden_files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.file("")))
      if (entry.path().filename().string().starts_with("."))
        names.push_back(entry.path().filename());
    return names;
  }

  TemporaryFolder folder_;
};

class SumoFilesOfBackEnds : public SumoFilesTest,
                            public ::testing::WithParamInterface<const char*> {};

double number(const Elements& elements, const std::string& element, const std::string& name) {
  const auto found = elements.find(element);
  if (found == elements.end() || !found->second.contains(name)) return std::nan("");
  return std::stod(found->second.at(name));
}

/// By how much a figure may differ that is made from places at the ends of steps, and of which the
/// step of an insertion is missing: a share of it, and so much more.
struct Tolerance {
  double share, more;
};

void expect_near(const Elements& sumos, const Elements& ours, const std::string& file,
                 const std::map<std::string, Tolerance>& tolerances) {
  ASSERT_FALSE(sumos.empty()) << file;
  std::size_t compared = 0;
  for (const auto& [element, attributes] : sumos) {
    ASSERT_TRUE(ours.contains(element)) << file << ": " << element;
    for (const auto& [name, value] : attributes) {
      const auto tolerance = tolerances.find(name);
      ASSERT_TRUE(ours.at(element).contains(name)) << file << ": " << element << " " << name;
      if (tolerance == tolerances.end()) continue;
      const double expected = std::stod(value);
      EXPECT_NEAR(number(ours, element, name), expected,
                  tolerance->second.share * std::abs(expected) + tolerance->second.more)
          << file << ": " << element << " " << name;
      ++compared;
    }
  }
  EXPECT_EQ(ours.size(), sumos.size()) << file;
  EXPECT_GT(compared, 0u) << file;
}

// with `called` nobody is driven by itself: SUMO drives all of them, and we write
TEST_F(SumoFilesTest, AreThoseOfSumoOnItsOwnDriving) {
  ProcessResult result = run("none");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::map<std::string, Elements> sumos = all_files();
  result = run("called");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::map<std::string, Elements> ours = all_files();
  EXPECT_TRUE(hidden_files().empty());

  const std::map<std::string, Tolerance> counts = {
      {"nVehContrib", {0, 0}}, {"nVehEntered", {0, 0}}, {"vehicleSum", {0, 0}},
      {"departed", {0, 0}},    {"arrived", {0, 0}},     {"entered", {0, 0}},
      {"left", {0, 0}},        {"nVehLeft", {0, 0}},    {"nVehSeen", {0, 0}}};
  std::map<std::string, Tolerance> loops = counts;
  loops.insert({{"flow", {0, 0}}, {"speed", {0.001, 0.02}}, {"occupancy", {0.001, 0.02}}});
  expect_near(sumos["e1.xml"], ours["e1.xml"], "e1.xml", loops);
  std::map<std::string, Tolerance> areas = counts;
  areas.insert({{"sampledSeconds", {0.01, 0.3}},
                {"meanSpeed", {0.01, 0.05}},
                {"meanOccupancy", {0.01, 0.05}},
                {"maxJamLengthInVehicles", {0, 0}},
                {"haltingDurationSum", {0.02, 0.3}}});
  expect_near(sumos["e2.xml"], ours["e2.xml"], "e2.xml", areas);
  std::map<std::string, Tolerance> ways = counts;
  ways.insert({{"meanTravelTime", {0.001, 0.1}},
               {"meanTimeLoss", {0.01, 0.15}},
               {"meanSpeed", {0.01, 0.1}},
               {"vehicleSumWithin", {0, 0}}});
  expect_near(sumos["e3.xml"], ours["e3.xml"], "e3.xml", ways);
  std::map<std::string, Tolerance> means = counts;
  means.insert({{"sampledSeconds", {0.005, 0.3}},
                {"traveltime", {0.01, 0.05}},
                {"density", {0.005, 0.02}},
                {"occupancy", {0.005, 0.02}},
                {"waitingTime", {0.01, 0.3}},
                {"timeLoss", {0.01, 0.5}},
                {"speed", {0.01, 0.02}}});
  for (const char* file : {"ed.xml.gz", "ed_bus.xml", "ld.xml", "edgedata.xml"})
    expect_near(sumos[file], ours[file], file, means);
  // whom SUMO drove keeps SUMO's own figures
  EXPECT_EQ(sumos["tripinfo.xml"], ours["tripinfo.xml"]);
  expect_near(sumos["summary.xml"], ours["summary.xml"], "summary.xml",
              {{"running", {0, 0}}, {"halting", {0, 1}}});
}

// by both back ends
TEST_P(SumoFilesOfBackEnds, CountWhomGammaDrives) {
  const ProcessResult result = run("all", "", GetParam());
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(hidden_files().empty());
  std::map<std::string, Elements> files = all_files();
  double cars = 0;
  for (const auto& [element, attributes] : files["e1.xml"])
    if (element.find("[e1]") != std::string::npos) cars += std::stod(attributes.at("nVehContrib"));
  EXPECT_GT(cars, 3.0);
  EXPECT_NE(content_of(folder_.file("ie.xml")).find("state=\"leave\""), std::string::npos);
  const Elements& trips = files["tripinfo.xml"];
  double number_of_trips = 0, time_loss = 0;
  for (const auto& [element, attributes] : trips) {
    if (element.find("/tripinfo[") == std::string::npos || attributes.contains("waitingTime") == 0)
      continue;
    ++number_of_trips;
    EXPECT_EQ(attributes.at("vaporized"), "") << element;
    const bool bike = element.find("[g.") != std::string::npos;
    EXPECT_NEAR(std::stod(attributes.at("routeLength")), bike ? 600.0 : 900.0, 15.0) << element;
    time_loss += std::stod(attributes.at("timeLoss"));
    EXPECT_EQ(attributes.at("departLane").substr(0, 2), "ab") << element;
    EXPECT_EQ(attributes.at("arrivalLane").substr(0, 2), bike ? "bc" : "cd") << element;
  }
  EXPECT_GT(number_of_trips, 20.0);
  EXPECT_GT(time_loss, 20.0);
  EXPECT_GT(number(files["statistic.xml"], "/vehicleTripStatistics", "timeLoss"), 0.5);
  EXPECT_NEAR(number(trips, "/personinfo[rider]/ride", "routeLength"), 550.0, 10.0);
  EXPECT_FALSE(trips.contains("/personinfo[rider]/stop"));
  const Elements& edges = files["edgedata.xml"];
  const std::string bc = "/interval[DEFAULT_EDGEDATA][0.00]/edge[bc]";
  EXPECT_EQ(number(edges, bc, "entered"), number(edges, bc, "left") + number(edges, bc, "arrived"));
  EXPECT_GT(number(edges, bc, "sampledSeconds"), 300.0);
  for (const auto& [element, attributes] : files["person-summary.xml"]) {
    EXPECT_GE(std::stod(attributes.at("riding")), 0.0);
    EXPECT_LE(std::stod(attributes.at("walking")), 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(BackEnds, SumoFilesOfBackEnds, ::testing::Values("traci", "libsumo"));

TEST_F(SumoFilesTest, BothBackEndsWriteTheSame) {
  std::map<std::string, std::string> texts[2];
  int run_index = 0;
  for (const char* backend : {"traci", "libsumo"}) {
    const ProcessResult result = run("car", "", backend);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    for (const char* file : {"e1.xml", "ie.xml", "e2.xml", "e3.xml", "ed.xml.gz", "ld.xml"})
      texts[run_index][file] = content_of(folder_.file(file));
    ++run_index;
  }
  for (const auto& [file, text] : texts[0]) {
    EXPECT_GT(text.size(), 300u) << file;
    EXPECT_EQ(text, texts[1][file]) << file;
  }
}

TEST_F(SumoFilesTest, FcdHasLanesAndPlacesThatFollow) {
  const ProcessResult result = run("all", "--output-prefix mine_");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(content_of(folder_.file("mine_fcd.xml")).c_str()));
  std::set<std::string> edges;
  double last = -1.0;
  for (const pugi::xml_node step : document.document_element().children())
    for (const pugi::xml_node agent : step.children()) {
      if (std::string(agent.attribute("id").value()) != "f.0") continue;
      const std::string lane = agent.attribute("lane").value();
      edges.insert(lane.substr(0, lane.rfind('_')));
      const double x = agent.attribute("x").as_double();
      EXPECT_GE(x, last - 0.5);
      last = x;
      if (!lane.starts_with("bc")) continue;
      EXPECT_NEAR(agent.attribute("pos").as_double(), x - 300.0, 25.0);
    }
  EXPECT_TRUE(edges.contains("ab") && edges.contains("bc") && edges.contains("cd"));
  EXPECT_TRUE(fs::exists(folder_.file("mine_e1.xml")));
  EXPECT_FALSE(fs::exists(folder_.file("e1.xml")));
}

TEST_F(SumoFilesTest, WhatWouldBeWrongIsRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"--lanechange-output l.xml", "option lanechange-output"},
      {"--netstate l.xml", "option netstate-dump"},
      {"--emission-output=l.xml", "option emission-output"},
      {"--device.ssm.probability 1", "option device.ssm.probability"},
      {"--device.emissions.probability 1", "option device.emissions.probability"},
      {"--human-readable-time", "human-readable-time"},
      {"--full-output stdout", "option full-output"}};
  for (const auto& [option, words] : cases) {
    const ProcessResult result = run("all", option);
    EXPECT_EQ(result.exit_code, 2) << option;
    EXPECT_NE(result.errors.find(words), std::string::npos) << result.errors;
  }
  EXPECT_EQ(run("none", "--lanechange-output " + folder_.file("l.xml")).exit_code, 0);
  EXPECT_EQ(run("all", "--lanechange-output NUL").exit_code, 0);
  for (const char* element :
       {"<routeProbe id='x' edge='ab' freq='60' file='x.xml'/>",
        "<edgeData id='x' type='emissions' file='x.xml'/>",
        "<e1Detector id='x' lane='ab_1' pos='5' file='x.xml' nextEdges='bc'/>",
        "<vTypeProbe id='x' freq='10' file='x.xml'/>"}) {
    write_user_scenario(folder_, kDemand, element);
    const ProcessResult result = run("all");
    EXPECT_EQ(result.exit_code, 2) << element;
    EXPECT_NE(result.errors.find("s.add.xml"), std::string::npos) << result.errors;
    EXPECT_FALSE(fs::exists(folder_.file("x.xml")));
  }
  EXPECT_TRUE(hidden_files().empty());
}

// SUMO's own complaint about the scenario leaves nothing behind
TEST_F(SumoFilesTest, ARunThatDoesNotStartLeavesNoFiles) {
  write_user_scenario(folder_, kDemand,
                      std::string(kAdditional) +
                          "<e1Detector id='e9' lane='nowhere_1' pos='1' "
                          "file='e9.xml'/>");
  EXPECT_EQ(run("all").exit_code, 2);
  EXPECT_TRUE(hidden_files().empty());
  EXPECT_FALSE(fs::exists(folder_.file("e1.xml")));
}

}  // namespace
}  // namespace sumogamma
