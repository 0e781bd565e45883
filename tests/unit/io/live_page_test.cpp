#include "io/live_page.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "io/replay_page.h"

namespace sumogamma {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A connection of a viewer that speaks for itself: may also be rude.
class Viewer {
 public:
  explicit Viewer(int port, const std::string& address = "127.0.0.1") {
    socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, address.c_str(), &to.sin_addr);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): as sockets have it
    connected_ = connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0;
    const timeval wait{5, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  }
  ~Viewer() { close(socket_); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  bool connected() const { return connected_; }
  void send_text(const std::string& text) const {
    EXPECT_EQ(send(socket_, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  void get(const std::string& path, const std::string& host) const {
    send_text("GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
  }
  /// What came until these words did, or the end.
  std::string read_to(const std::string& words) {
    char block[4096];
    while (words.empty() || text_.find(words) == std::string::npos) {
      const ssize_t count = recv(socket_, block, sizeof block, 0);
      if (count <= 0) break;
      text_.append(block, static_cast<std::size_t>(count));
    }
    return text_;
  }

 private:
  int socket_ = -1;
  bool connected_ = false;
  std::string text_;
};

std::string host_of(const LivePage& page) { return "127.0.0.1:" + std::to_string(page.port()); }

void wait_for_viewers(const LivePage& page, bool there) {
  for (int i = 0; i < 1000 && page.has_viewers() != there; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(page.has_viewers(), there);
}

TEST(LivePage, GivesThePageAndNothingElse) {
  LivePage page(0);
  const auto answer = [&](const std::string& path, const std::string& host) {
    Viewer viewer(page.port());
    viewer.get(path, host);
    return viewer.read_to("");
  };
  const std::string got = answer("/", host_of(page));
  EXPECT_THAT(got, HasSubstr("200 OK"));
  EXPECT_THAT(got, HasSubstr(live_replay_page()));
  EXPECT_THAT(got, HasSubstr("Content-Security-Policy"));
  EXPECT_THAT(answer("/../etc/passwd", host_of(page)), HasSubstr("404"));
  // by a name that somebody else's page has for this address
  EXPECT_THAT(answer("/", "evil.example:" + std::to_string(page.port())), HasSubstr("403"));
  Viewer writer(page.port());
  writer.send_text("POST / HTTP/1.1\r\nHost: " + host_of(page) +
                   "\r\nContent-Length: 5\r\n\r\nhello");
  EXPECT_THAT(writer.read_to(""), Not(HasSubstr("200 OK")));
}

TEST(LivePage, TellsWhoJoinsWhatBelongsTogether) {
  LivePage page(0);
  page.begin("HEADER");
  page.publish("old", true);
  page.publish_marks("mark");
  page.publish("fresh", true);
  page.publish("later", false);
  Viewer viewer(page.port());
  viewer.get("/events", host_of(page));
  viewer.read_to(base64("later"));
  wait_for_viewers(page, true);
  page.publish("new", false);
  const std::string got = viewer.read_to(base64("new"));
  EXPECT_THAT(got, HasSubstr("text/event-stream"));
  const auto at = [&](const char* words) { return got.find("data: " + base64(words) + "\n\n"); };
  EXPECT_EQ(at("old"), std::string::npos) << "from the newest beginning on";
  EXPECT_LT(at("HEADER"), at("mark"));
  EXPECT_LT(at("mark"), at("fresh"));
  EXPECT_LT(at("fresh"), at("later"));
  EXPECT_LT(at("later"), at("new"));
}

TEST(LivePage, HasRoomForSoManyViewers) {
  LivePage page(0);
  page.begin("HEADER");
  page.publish("one", true);
  std::vector<std::unique_ptr<Viewer>> viewers;
  for (std::size_t i = 0; i < LivePage::kMostViewers; ++i) {
    viewers.push_back(std::make_unique<Viewer>(page.port()));
    viewers.back()->get("/events", host_of(page));
    EXPECT_THAT(viewers.back()->read_to(base64("one")), HasSubstr(base64("one")));
  }
  Viewer late(page.port());
  late.get("/events", host_of(page));
  EXPECT_THAT(late.read_to(""), HasSubstr("503"));
  viewers.clear();
  wait_for_viewers(page, false);
}

/// A viewer that reads nothing while far more comes than any buffer holds.
TEST(LivePage, NeverWaitsForAViewer) {
  using Clock = std::chrono::steady_clock;
  auto page = std::make_unique<LivePage>(0);
  page->begin("HEADER");
  const Viewer deaf(page->port());
  deaf.get("/events", host_of(*page));
  wait_for_viewers(*page, true);
  Clock::duration longest{};
  for (int i = 0; i < 300; ++i) {
    if (i == 100) Viewer(page->port()).get("/events", host_of(*page));  // and one that goes away
    const Clock::time_point before = Clock::now();
    page->publish(std::string(200000, 'x'), i % 10 == 0);
    longest = std::max(longest, Clock::now() - before);
  }
  EXPECT_LT(longest, std::chrono::milliseconds(500));
  const Clock::time_point end = Clock::now();
  page.reset();
  EXPECT_LT(Clock::now() - end, std::chrono::seconds(10)) << "its end comes, too";
}

TEST(LivePage, SaysThatTheRunIsOver) {
  auto page = std::make_unique<LivePage>(0);
  page->begin("HEADER");
  Viewer viewer(page->port());
  viewer.get("/events", host_of(*page));
  viewer.read_to(base64("HEADER"));
  page.reset();
  EXPECT_THAT(viewer.read_to("event: over"), HasSubstr("event: over"));
}

TEST(LivePage, APortInUseIsAnErrorThatSaysSo) {
  const LivePage page(0);
  try {
    const LivePage other(page.port());
    FAIL() << "two at one port";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("--serve " + std::to_string(page.port())));
    EXPECT_THAT(error.what(), HasSubstr("another port"));
  }
}

}  // namespace
}  // namespace sumogamma
