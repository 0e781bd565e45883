#include "osm/repairs/signal_offsets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <sstream>

#include "base/error.h"
#include "osm/network_file.h"
#include "support/plain_net.h"

namespace sumogamma::osm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;

/// Lanes in a row, each `length` long, 8 m/s, with a signal of one link, named s0, s1, ... wherever
/// one goes on to the next.
RoadNetwork row_of_signals(const std::vector<double>& lengths) {
  RoadNetwork road;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    Lane lane;
    lane.length = lengths[i];
    lane.speed_limit = 8.0;
    if (i > 0) {
      Connection link;
      link.from = static_cast<LaneId>(i - 1);
      link.to = static_cast<LaneId>(i);
      link.signal = static_cast<SignalId>(i - 1);
      link.signal_link = 0;
      const auto id = static_cast<ConnectionId>(road.connections.size());
      road.lanes.back().outgoing.push_back(id);
      lane.incoming.push_back(id);
      road.connections.push_back(link);
      road.signals.push_back({"s" + std::to_string(i - 1), 1, {}});
    }
    road.lanes.push_back(lane);
  }
  return road;
}

/// Green from a second on, for as long.
SignalProgram program(const std::string& name, int cycle, int green_from, int green) {
  SignalProgram made{name, std::vector<std::string>(static_cast<std::size_t>(cycle), "r")};
  for (int second = green_from; second < green_from + green; ++second)
    made.states[static_cast<std::size_t>(second % cycle)] = "G";
  return made;
}

TEST(SignalOffsets, ThePlatoonFindsTheNextLightGreen) {
  // 16 m at 8 m/s and a second to set out: green at one is to be green at the other 3 s later
  const RoadNetwork road = row_of_signals({100, 16, 100});
  for (const int green_from : {0, 5, 13}) {
    const auto offsets =
        signal_offsets(road, {program("s0", 20, 2, 6), program("s1", 20, green_from, 6)});
    ASSERT_EQ(offsets.size(), 2U);
    const int first = 2 + offsets.at("s0"), second = green_from + offsets.at("s1");
    EXPECT_EQ((first + 3) % 20, second % 20) << green_from;
    for (const auto& [name, offset] : offsets) {
      EXPECT_GE(offset, 0) << name;
      EXPECT_LT(offset, 20) << name;
    }
  }
}

// bicycles of a path stood through the light at which the few of them came who ride on the roads
TEST(SignalOffsets, ThoseOfAPathCountForMoreThanTheFewWhoComeOntoItFromRoads) {
  RoadNetwork road = row_of_signals({100, 1, 100});
  for (Lane& lane : road.lanes) lane.allowed = vehicle_class::kBicycle;
  for (const int other : {1, 2}) {
    Lane lane;
    lane.length = 100;
    Connection link = road.connections.front();
    link.from = static_cast<LaneId>(road.lanes.size());
    link.signal_link = other;
    const auto id = static_cast<ConnectionId>(road.connections.size());
    lane.outgoing.push_back(id);
    road.lanes[1].incoming.push_back(id);
    road.connections.push_back(link);
    road.lanes.push_back(lane);
  }
  SignalProgram first{"s0", std::vector<std::string>(20, "rrr")};
  for (int second = 2; second < 8; ++second) {
    first.states[static_cast<std::size_t>(second)] = "Grr";
    first.states[static_cast<std::size_t>(second + 10)] = "rGG";
  }
  const auto offsets = signal_offsets(road, {first, program("s1", 20, 0, 6)});
  // a second to set out, and the metre between them in none: those of the path go on at once
  EXPECT_EQ((2 + offsets.at("s0") + 1) % 20, offsets.at("s1") % 20);
}

TEST(SignalOffsets, ARowOfThreeIsAWave) {
  const auto offsets =
      signal_offsets(row_of_signals({100, 16, 24, 100}),
                     {program("s0", 30, 0, 8), program("s1", 30, 20, 8), program("s2", 30, 3, 8)});
  ASSERT_EQ(offsets.size(), 3U);
  EXPECT_EQ((offsets.at("s0") + 3) % 30, (20 + offsets.at("s1")) % 30);
  EXPECT_EQ((20 + offsets.at("s1") + 4) % 30, (3 + offsets.at("s2")) % 30);
}

TEST(SignalOffsets, OthersAreLeftAlone) {
  const SignalProgram first = program("s0", 20, 0, 6), second = program("s1", 20, 10, 6);
  EXPECT_THAT(signal_offsets(row_of_signals({100, 80, 100}), {first, second}), IsEmpty());
  EXPECT_THAT(signal_offsets(row_of_signals({100, 16, 100}), {first, program("s1", 25, 10, 6)}),
              IsEmpty());
  EXPECT_THAT(signal_offsets(row_of_signals({100, 16, 100}), {first}), IsEmpty());
  // never green, and a program without a letter for the link
  EXPECT_THAT(signal_offsets(row_of_signals({100, 16, 100}), {first, program("s1", 20, 10, 0)}),
              IsEmpty());
  EXPECT_THAT(
      signal_offsets(row_of_signals({100, 16, 100}), {first, {"s1", std::vector<std::string>(20)}}),
      IsEmpty());
  // those far off stand as they are, close ones are set to each other
  EXPECT_THAT(
      signal_offsets(row_of_signals({100, 16, 80, 100}), {first, second, program("s2", 20, 5, 6)}),
      ElementsAre(Key("s0"), Key("s1")));
}

TEST(SignalOffsets, ProgramsAreReadSecondBySecondAndGetTheirOffsets) {
  pugi::xml_document document;
  document.load_string(R"(<net><location x="&lt;1"/>
      <tlLogic id="a" type="static" programID="0" offset="0">
        <phase duration="2" state="Gr"/><phase duration="1" state="yr"/></tlLogic>
      <tlLogic id="b" type="static" programID="0"><phase duration="3.00" state="rG"/></tlLogic>
      <tlLogic id="c" type="static" programID="0" offset="7"><phase duration="2.5" state="G"/></tlLogic>
      <junction id="j"/></net>)");
  const pugi::xml_node net = document.child("net");
  const std::vector<SignalProgram> programs = read_signal_programs(net);
  ASSERT_EQ(programs.size(), 2U);  // c's times are no whole seconds
  EXPECT_EQ(programs[0].name, "a");
  EXPECT_THAT(programs[0].states, ElementsAre("Gr", "Gr", "yr"));
  EXPECT_THAT(programs[1].states, ElementsAre("rG", "rG", "rG"));
  set_signal_offsets(net, {{"a", 2}, {"b", 1}, {"z", 5}});
  std::ostringstream written;
  document.save(written);
  const std::string text = written.str();
  EXPECT_THAT(text, HasSubstr(R"(id="a" type="static" programID="0" offset="2")"));
  EXPECT_THAT(text, HasSubstr(R"(id="b" type="static" programID="0" offset="1")"));
  EXPECT_THAT(text, HasSubstr(R"(programID="0" offset="7")"));
  EXPECT_THAT(text, HasSubstr(R"(x="&lt;1")"));
  EXPECT_EQ(read_signal_programs(net).size(), 2U);
}

class SignalFileTest : public ::testing::Test {
 protected:
  ~SignalFileTest() override { std::filesystem::remove(file_); }
  const std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                      ("sumogamma_signals_" + std::to_string(getpid()) + ".xml");
};

// two crossings of one main road 30 m apart, as netconvert makes them: who gets green at one of
// them at its begin gets over the other without a halt
TEST_F(SignalFileTest, LightsThatNetconvertMadeGetOffsets) {
  sumogamma::testing::PlainNet plain;
  plain.nodes = R"(<node id="W" x="-200" y="0"/><node id="A" x="0" y="0" type="traffic_light"/>
      <node id="B" x="50" y="0" type="traffic_light"/><node id="E" x="250" y="0"/>
      <node id="N" x="0" y="150"/><node id="S" x="50" y="-150"/>)";
  plain.edges = R"(<edge id="WA" from="W" to="A" numLanes="2" speed="13"/>
      <edge id="AB" from="A" to="B" numLanes="2" speed="13"/>
      <edge id="BE" from="B" to="E" numLanes="2" speed="13"/>
      <edge id="NA" from="N" to="A" speed="13"/><edge id="SB" from="S" to="B" speed="13"/>)";
  sumogamma::testing::write_plain_net(plain, file_);
  const NetworkFile network = load_network(file_);
  const auto offsets = signal_offsets(network.road, read_signal_programs(network.net()));
  ASSERT_THAT(offsets, ElementsAre(Key("A"), Key("B")));
  EXPECT_NE(offsets.at("A"), offsets.at("B"));
  set_signal_offsets(network.net(), offsets);
  EXPECT_EQ(read_sumo_net(network.document, file_).signals.size(), 2U);
}

}  // namespace
}  // namespace sumogamma::osm
