#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "base/subprocess.h"

namespace sumogamma {

/// A folder that goes away with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "sumogamma-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(path_ / name);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path path_;
};

/// A user's scenario s.sumocfg on net.net.xml, with its demand and what stands in additional files.
inline void write_user_scenario(const TemporaryFolder& folder, const std::string& demand,
                                const std::string& additional, const std::string& more_input = "") {
  folder.write("d.rou.xml", "<routes>" + demand + "</routes>");
  folder.write("s.add.xml", "<additional>" + additional + "</additional>");
  folder.write("s.sumocfg",
               "<configuration><input><net-file value='net.net.xml'/><route-files "
               "value='d.rou.xml'/><additional-files value='s.add.xml'/>" +
                   more_input + "</input></configuration>");
}

/// A grid of 3 x 3 signalled junctions, 150 m apart, with sidewalks and crossings, and a little
/// demand:
///
///   A2 -- B2 -- C2     vehicles   v0 (t=0), stopper (t=1, stops 10 s on A1B1), odd (an id of odd
///   letters, t=2) |     |     |      persons    walker (t=0: two walks), strollers (t=1: one walk)
///   A1 -- B1 -- C1
///   |     |     |
///   A0 -- B0 -- C0
class CouplingScenario {
 public:
  static constexpr const char* kOddId = "odd#1(100%)\xc3\xa9$`{x}[y]~^";

  CouplingScenario() {
    ProcessRequest request;
    request.arguments = {"netgenerate",
                         "--grid",
                         "--grid.number",
                         "3",
                         "--grid.length",
                         "150",
                         "--default.lanenumber",
                         "2",
                         "--sidewalks.guess",
                         "--crossings.guess",
                         "--default-junction-type",
                         "traffic_light",
                         "--tls.default-type",
                         "actuated",
                         "--seed",
                         "1",
                         "-o",
                         folder_.file("net.net.xml")};
    const ProcessResult result = run_process(request);
    if (!result.ok()) throw std::runtime_error("netgenerate failed: " + result.errors);
    folder_.write("routes.rou.xml", R"(<routes>
  <vType id="car" vClass="passenger" length="4.5" width="1.8" height="1.5" maxSpeed="33" speedDev="0"/>
  <vehicle id="v0" type="car" depart="0" departPos="20" departSpeed="max"><route edges="A0A1 A1A2 A2B2"/></vehicle>
  <person id="walker" depart="0" departPos="10">
    <walk edges="B0B1 B1B2" arrivalPos="30"/><walk edges="B1B2 B2C2" arrivalPos="40"/>
  </person>
  <vehicle id="stopper" type="car" depart="1"><route edges="A1B1 B1C1"/>
    <stop lane="A1B1_1" startPos="60" endPos="80" duration="10"/></vehicle>
  <person id="stroller" depart="1" departPos="10"><walk edges="C0C1" arrivalPos="60"/></person>
  <vehicle id="odd#1(100%)&#233;$`{x}[y]~^" type="car" depart="2"><route edges="C2B2 B2A2"/></vehicle>
</routes>)");
    write_config("scenario.sumocfg", "net.net.xml", "routes.rou.xml");
  }

  void write_config(const std::string& name, const std::string& net,
                    const std::string& routes) const {
    folder_.write(name, "<configuration><input><net-file value=\"" + net +
                            "\"/><route-files value=\"" + routes + "\"/></input></configuration>");
  }
  const TemporaryFolder& folder() const { return folder_; }
  std::string config() const { return folder_.file("scenario.sumocfg"); }

 private:
  TemporaryFolder folder_;
};

/// Waits until somebody listens on a port of this machine, without touching it: half a minute at
/// the most.
inline void wait_until_listening(int port) {
  char wanted[16];
  std::snprintf(wanted, sizeof wanted, ":%04X", static_cast<unsigned>(port));
  for (int k = 0; k < 600; ++k) {
    std::ifstream sockets("/proc/net/tcp");
    for (std::string line; std::getline(sockets, line);) {
      std::istringstream words(line);
      std::string number, local, remote, state;
      words >> number >> local >> remote >> state;
      if (state == "0A" && local.ends_with(wanted)) return;  // TCP_LISTEN
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace sumogamma
