#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/subprocess.h"
#include "io/output_file.h"
#include "support/headless.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

const fs::path kTown =
    fs::path(SUMOGAMMA_SOURCE_DIR) / "tests/support/osm/signalled_crossing_right.osm";

/// A socket at 127.0.0.1: one that listens (port 0: any), or one that has connected.
class Socket {
 public:
  static Socket listening() {
    Socket one;
    sockaddr_in address = one.local(0);
    socklen_t size = sizeof address;
    // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): as sockets have it
    EXPECT_EQ(bind(one.socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(one.socket_, 1), 0);
    getsockname(one.socket_, reinterpret_cast<sockaddr*>(&address), &size);
    // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
    one.port = ntohs(address.sin_port);
    return one;
  }
  /// Tries for a while: the other side may not be there yet.
  static Socket connected(int port) {
    for (int i = 0; i < 1000; ++i) {
      Socket one;
      const sockaddr_in address = one.local(port);
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast)
      const auto* const to = reinterpret_cast<const sockaddr*>(&address);
      if (connect(one.socket_, to, sizeof address) == 0) return one;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "nobody listens at " << port;
    return {};
  }
  Socket(Socket&& other) noexcept : port(other.port), socket_(other.socket_) { other.socket_ = -1; }
  ~Socket() {
    if (socket_ >= 0) close(socket_);
  }
  void ask(const std::string& path) const {
    const std::string text =
        "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n";
    EXPECT_EQ(send(socket_, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  std::string read_to(const std::string& words) const {
    std::string text;
    char block[65536];
    while (text.find(words) == std::string::npos) {
      const ssize_t count = recv(socket_, block, sizeof block, 0);
      if (count <= 0) break;
      text.append(block, static_cast<std::size_t>(count));
    }
    return text;
  }

  int port = 0;

 private:
  Socket() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {}
  sockaddr_in local(int wanted) {
    port = wanted;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(wanted));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }
  int socket_ = -1;
};

class LiveRun : public ::testing::Test {
 protected:
  LiveRun() {
    folder_ = fs::temp_directory_path() / ("sumogamma_live_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    const ProcessResult made = program({"import", kTown.string(), "-o", scenario(), "--agents",
                                        "40", "--duration", "3000", "--quiet"});
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    free_port_ = Socket::listening().port;
  }
  ~LiveRun() override { fs::remove_all(folder_); }

  ProcessResult program(std::vector<std::string> arguments) {
    ProcessRequest request;
    request.arguments = std::move(arguments);
    request.arguments.insert(request.arguments.begin(), SUMOGAMMA_PROGRAM);
    request.should_stop = [this] { return stop_.load(); };
    return run_process(request);
  }
  ProcessResult run(const std::string& output, std::vector<std::string> more) {
    std::vector<std::string> words = {"run", scenario(), "-o", (folder_ / output).string()};
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  }
  json results_in(const std::string& output) const {
    return json::parse(read_file(folder_ / output / "results.json"));
  }
  std::string scenario() const { return (folder_ / "town").string(); }

  fs::path folder_;
  int free_port_ = 0;
  std::atomic<bool> stop_ = false;
};

TEST_F(LiveRun, IsTheSameRunWhoeverLooksOn) {
  const std::vector<std::string> plain = {"--duration", "40", "--quiet"};
  std::vector<std::string> served = plain;
  served.insert(served.end(), {"--serve", std::to_string(free_port_), "--inspect", "5%"});
  ASSERT_EQ(run("plain", plain).exit_code, 0);
  ProcessResult result;
  std::thread other([&] { result = run("served", served); });
  const Socket reader = Socket::connected(free_port_), deaf = Socket::connected(free_port_);
  reader.ask("/events");
  deaf.ask("/events");
  { const Socket brief = Socket::connected(free_port_); }
  const std::string stream = reader.read_to("event: over");
  other.join();
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("shown at http://127.0.0.1:" + std::to_string(free_port_)));
  EXPECT_THAT(stream, HasSubstr("event: header"));
  EXPECT_THAT(stream, HasSubstr("event: records"));
  EXPECT_EQ(results_in("served")["state_hash"], results_in("plain")["state_hash"]);
}

TEST_F(LiveRun, APortInUseIsRefusedBeforeAnythingStarts) {
  const Socket taken = Socket::listening();
  const ProcessResult result =
      run("refused", {"--serve", std::to_string(taken.port), "--duration", "5"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.errors.find("sumo-gamma: --serve " + std::to_string(taken.port)), 0u)
      << result.errors;
  EXPECT_FALSE(fs::exists(folder_ / "refused"));
}

TEST_F(LiveRun, PlaysInChromium) {
  if (find_program("chromium").empty())
    GTEST_SKIP() << "no chromium in PATH: the live page was NOT tested in a browser";
  ProcessResult result;
  std::thread other([&] {
    result = run("live", {"--serve", std::to_string(free_port_), "--duration", "3000"});
  });
  { const Socket there = Socket::connected(free_port_); }
  ProcessRequest request;
  request.arguments = testing::headless_chromium(
      folder_ / "chromium",
      {"--timeout=6000", "http://127.0.0.1:" + std::to_string(free_port_) + "/"});
  request.time_limit = 120;
  // it looks for as long as it likes, which may be too short to see much
  ProcessResult seen;
  int steps = 0;
  for (int i = 0; i < 5 && steps < 5; ++i) {
    seen = run_process(request);
    const std::size_t at = seen.output.find("data-steps=\"");
    if (at != std::string::npos) steps = std::stoi(seen.output.substr(at + 12));
  }
  stop_ = true;
  other.join();
  EXPECT_EQ(seen.errors.find("CONSOLE"), std::string::npos) << seen.errors;
  EXPECT_THAT(seen.output, HasSubstr("data-state=\"ready\""));
  EXPECT_THAT(seen.output, HasSubstr("● live</button>"));
  EXPECT_GE(steps, 5) << "steps came while it looked on";
  EXPECT_EQ(results_in("live")["ended"], "interrupted");
}

TEST_F(LiveRun, RecordsTheVelocitySpacesThatWereAskedFor) {
  EXPECT_EQ(run("alone", {"--inspect", "car.0"}).exit_code, 2) << "nothing would show them";
  const ProcessResult unknown = run("unknown", {"--replay", "--inspect", "car.x"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("--inspect car.x"));
  ASSERT_EQ(
      run("inspected", {"--replay", "--inspect", "car,pedestrian", "--duration", "40", "--quiet"})
          .exit_code,
      0);
  if (find_program("node").empty())
    GTEST_SKIP() << "no node in PATH: the recording was NOT read by the page's decoder";
  ProcessRequest request;
  request.arguments = {"node", SUMOGAMMA_SOURCE_DIR "/tests/support/decode_replay.mjs",
                       SUMOGAMMA_SOURCE_DIR, (folder_ / "inspected" / "replay.bin").string()};
  const ProcessResult read = run_process(request);
  ASSERT_TRUE(read.ok()) << read.errors;
  const json found = json::parse(read.output);
  std::vector<std::size_t> in_step(found["times"].size(), 0);
  std::size_t kinds[6] = {};
  std::size_t compared = 0;
  for (const json& agent : found["agents"]) {
    const std::string id = std::to_string(agent["id"].get<int>());
    if (!found["spaces"].contains(id)) continue;
    const std::string name = agent["name"];
    EXPECT_TRUE(name.find("car.") == 0 || name.find("pedestrian.") == 0) << name;
    for (const json& space : found["spaces"][id]) {
      ++in_step[space["step"].get<std::size_t>()];
      for (const json& plane : space["planes"]) ++kinds[plane["kind"].get<std::size_t>()];
      // it chose within what is hard, but for where a half-plane's normal was rounded
      for (std::size_t i = 0; i < space["hard"]; ++i) {
        const json& plane = space["planes"][i];
        const double slack = plane["normal"][0].get<double>() * space["answer"][0].get<double>() +
                             plane["normal"][1].get<double>() * space["answer"][1].get<double>() -
                             plane["offset"].get<double>();
        EXPECT_GT(slack, -0.006) << name;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 1000u);
  EXPECT_GT(kinds[0], 0u) << "K";
  EXPECT_GT(kinds[1], 0u) << "G";
  EXPECT_GT(kinds[3], 0u) << "C";
  EXPECT_LE(*std::max_element(in_step.begin(), in_step.end()), 16u) << "bounded";
}

}  // namespace
}  // namespace sumogamma
