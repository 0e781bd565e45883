#include "osm/recorded_signals.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"
#include "road/sumo_net_reader.h"
#include "support/plain_net.h"

namespace sumogamma::osm {
namespace {

namespace fs = std::filesystem;

class RecordedSignals : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("signals_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path file(const char* name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string refusal(const std::string& text) const {
    try {
      read_signal_changes(file("s.csv", text), 0.1);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(RecordedSignals, ReadsFramesAndTimesInEachWayOfSayingStates) {
  const SignalChanges frames =
      read_signal_changes(file("a.csv",
                               "signal_group,frame,state\n1,0,STOP_AND_REMAIN\n1,458,PRE_MOVEMENT\n"
                               "1,468,PERMISSIVE_MOVEMENT_ALLOWED\n2,0,DARK\n"),
                          0.1);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames.at(1).at(0.1 * 458), 'u');
  EXPECT_EQ(frames.at(1).rbegin()->second, 'G');
  EXPECT_EQ(frames.at(2).at(0.0), 'O');
  const SignalChanges times = read_signal_changes(
      file("b.csv", "time_s,signal_group,state\n0,3,0\n4.5,3,1\n9,3,3\n12,3,r\n"), 0.1);
  EXPECT_EQ(times.at(3).at(4.5), 'G');
  EXPECT_EQ(times.at(3).at(9.0), 'y');
  EXPECT_EQ(times.at(3).at(12.0), 'r');
}

TEST_F(RecordedSignals, RefusesWhatItDoesntUnderstandByLine) {
  EXPECT_NE(refusal("group,frame,state\n").find("s.csv:1: lacks a column"), std::string::npos);
  EXPECT_NE(refusal("signal_group,frame,state\n1,0,BLUE\n").find("s.csv:2"), std::string::npos);
  EXPECT_NE(refusal("signal_group,frame,state\n1,0,r\nx,1,r\n").find("s.csv:3"), std::string::npos);
  EXPECT_NE(refusal("signal_group,frame,state\n").find("has no changes"), std::string::npos);
  EXPECT_THROW(read_signal_map(file("m.kml", "<osm/>"), {}), Error);
}

TEST_F(RecordedSignals, ShowsInTheNetworkWhatWasRecorded) {
  const fs::path net = folder_ / "c.net.xml";
  testing::write_plain_net(testing::crossroads("traffic_light"), net);
  EXPECT_TRUE(replayed_signals(net).empty()) << "a program like any other";
  // group 1 for the ways from the west straight on, 2 from the south straight on
  const std::vector<SignalledWay> ways{{1, {-15, -4.8}, {15, -4.8}}, {2, {1.6, -15}, {1.6, 15}}};
  SignalChanges changes;
  changes[1] = {{0.0, 'r'}, {20.0, 'G'}, {30.0, 'y'}, {33.0, 'r'}};
  changes[2] = {{0.0, 'G'}, {15.0, 'r'}};
  const SignalReplay replay = replay_signals(net, ways, changes, 5.0);
  EXPECT_EQ(replay.signals, 1u);
  EXPECT_GT(replay.unknown, 0u) << "turns of which nobody told";
  EXPECT_EQ(replay.phases, 5u) << "from 5 s on: as it begins, at 15, 20, 30 and 33 s";
  const RoadNetwork road = read_sumo_net(net);
  const Signal& signal = road.signals.at(0);
  const auto shown = [&](const char* from, const char* to, std::size_t phase) {
    for (const Connection& link : road.connections)
      if (link.signal_link >= 0 && road.edge(road.lane(link.from).edge).name == from &&
          road.edge(road.lane(link.to).edge).name == to)
        return signal.phases.at(phase).state.at(static_cast<std::size_t>(link.signal_link));
    return '?';
  };
  EXPECT_DOUBLE_EQ(signal.phases.at(0).duration, 10.0);
  EXPECT_DOUBLE_EQ(signal.phases.at(2).duration, 10.0);
  EXPECT_EQ(shown("SC", "CN", 0), 'G');
  EXPECT_EQ(shown("WC", "CE", 0), 'r');
  EXPECT_EQ(shown("SC", "CN", 1), 'r');
  EXPECT_EQ(shown("WC", "CE", 2), 'G');
  EXPECT_EQ(shown("WC", "CE", 3), 'y');
  EXPECT_EQ(shown("WC", "CE", 4), 'r');
  EXPECT_EQ(replayed_signals(net), std::set<std::string>{signal.name});
}

}  // namespace
}  // namespace sumogamma::osm
