#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace httplib {
class Server;
}

namespace sumogamma {

/// The replay page while a run goes on: a server on 127.0.0.1 that gives the page and, as
/// server-sent events, the records of a ReplayEncoder in base64. Viewers can ask for nothing else.
/// The run never waits for one: it leaves what is new here, a thread a viewer takes it from here,
/// who falls behind by more than is kept goes on with what is newest, and who takes nothing is
/// dropped.
class LivePage {
 public:
  static constexpr std::size_t kMostViewers = 8;
  static constexpr std::size_t kMostMarks = 5000;  ///< kept for who joins later

  /// Listens on `port`, 0: any free one. Throws Error naming --serve where that isn't possible.
  explicit LivePage(int port);
  /// Viewers are told that the run is over.
  ~LivePage();
  LivePage(const LivePage&) = delete;
  LivePage& operator=(const LivePage&) = delete;

  int port() const { return port_; }
  std::string address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/"; }
  bool has_viewers() const { return viewers_ > 0; }

  /// The header of the recording, once.
  void begin(const std::string& header);
  /// Records as they come. `fresh`: they begin with ReplayEncoder::begin_again, so viewers can join
  /// here.
  void publish(const std::string& records, bool fresh);
  /// Records of events, which who joins later gets, too.
  void publish_marks(const std::string& records);

 private:
  using Message = std::shared_ptr<const std::string>;
  /// One's place in the stream.
  struct Viewer {
    bool greeted = false, told_of_end = false;
    std::uint64_t next = 0;
  };
  void route();
  void append(Message message);
  std::vector<Message> wait_for(Viewer& viewer);

  std::unique_ptr<httplib::Server> server_;
  int port_ = 0;
  std::atomic<std::size_t> viewers_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  Message header_;
  std::deque<Message> marks_, recent_;
  std::uint64_t first_ = 0;          ///< number of the first of `recent_`
  std::deque<std::uint64_t> fresh_;  ///< numbers at which viewers can join, those of `recent_`
  bool over_ = false;

  std::thread thread_;  ///< accepts
};

}  // namespace sumogamma
