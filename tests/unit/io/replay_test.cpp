#include "io/replay.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/output_file.h"
#include "io/replay_map.h"
#include "io/replay_page.h"
#include "support/small_net.h"
#include "support/synthetic_traffic.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

class Replay : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("sumogamma_replay_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
  AgentName name_ = [](AgentId id) -> std::string_view { return id.value % 2 ? "odd" : "even"; };
};

TEST_F(Replay, MapHoldsWhatIsDrawn) {
  const auto map =
      nlohmann::json::parse(replay_map_json("Small", testing::small_net(), default_agent_types()));
  EXPECT_EQ(map.at("lanes").size(), 11u);
  // in_1 and both ends of the crossing
  EXPECT_EQ(map.at("stopLines").size(), 3u);
  EXPECT_EQ(map.at("types").size(), default_agent_types().size());
  std::size_t bridges = 0;
  for (const auto& lane : map.at("lanes")) bridges += lane.contains("z");
  EXPECT_EQ(bridges, 1u);
}

TEST_F(Replay, PageIsSelfContained) {
  const RoadNetwork net = testing::small_net();
  testing::SyntheticTraffic traffic(net, 20, 0.05);
  {
    ReplayRecorder recorder(folder_ / "replay.bin", "Small", net, traffic.types);
    for (int tick = 0; tick < 100; ++tick) {
      recorder.add({traffic.scene, name_, &traffic.road});
      traffic.advance();
    }
    recorder.add_event({ReplayEventKind::Collision, 2.0, {10, 0}, AgentId{1}, AgentId{2}, ""});
    recorder.close();
    recorder.close();
    EXPECT_THROW(recorder.add({traffic.scene, name_}), Error);
  }
  write_replay_page(folder_ / "replay.html", folder_ / "replay.bin");
  const std::string page = read_file(folder_ / "replay.html");
  for (const char* outside : {"http://", "https://", "src=", "@import", "<link", "url("})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  for (const char* mark : {"/*STYLE*/", "/*SCRIPT*/", "<!--DATA-->"})
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
}

TEST_F(Replay, WorksWithoutRoads) {
  Scene scene;
  AgentState agent;
  agent.footprint = box_footprint(1, 1);
  append_agent(scene, agent);
  ReplayRecorder recorder(folder_ / "replay.bin", "Scene", RoadNetwork{}, default_agent_types());
  recorder.add({scene, name_});
  recorder.close();
  EXPECT_NO_THROW(write_replay_page(folder_ / "replay.html", folder_ / "replay.bin"));
}

TEST_F(Replay, WhatIsNoRecordingIsRefused) {
  EXPECT_THROW(write_replay_page(folder_ / "a.html", folder_ / "absent.bin"), Error);
  std::ofstream(folder_ / "plain.bin") << "SGR1 but not gzipped";
  EXPECT_THROW(write_replay_page(folder_ / "a.html", folder_ / "plain.bin"), Error);
  std::ofstream(folder_ / "empty.bin") << "";
  EXPECT_THROW(write_replay_page(folder_ / "a.html", folder_ / "empty.bin"), Error);
  EXPECT_FALSE(fs::exists(folder_ / "a.html"));
}

TEST_F(Replay, AFullDiskNamesTheFile) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  ReplayRecorder recorder("/dev/full", "Full", testing::small_net(), default_agent_types());
  EXPECT_THROW(recorder.close(), Error);
}

}  // namespace
}  // namespace sumogamma
