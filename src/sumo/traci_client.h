#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sumo/sumo_process.h"
#include "sumo/traci_message.h"

namespace sumogamma {

/// Until when SUMO is waited for. A child that computes meanwhile puts it off: loading a country's
/// roads or routing a day's trips in one step takes minutes. One that only sleeps, or is stopped,
/// doesn't, and nobody does for ever.
class Deadline {
 public:
  /// `timeout` [s]; `child`: ours, or null.
  Deadline(double timeout, const SumoProcess* child);
  /// [s]; not positive: it is over.
  double left();

 private:
  static constexpr double kBusyShare = 0.02;  ///< of the time, from which on a child computes
  static constexpr int kMostDelays = 30;

  const SumoProcess* child_;
  double timeout_, end_, cpu_before_;
  int delays_ = 0;
};

/// One TCP connection to a SUMO: a message out, its reply in. It never blocks for longer than
/// asked (see Deadline), never raises SIGPIPE, and notices within a tenth of a second when the
/// child has died.
class TraciClient {
 public:
  /// Connects within `timeout` seconds (Deadline). Where nobody listens it keeps trying until the
  /// child ends; without one (null) it gives up within two seconds. Throws SumoError.
  TraciClient(const std::string& host, int port, double timeout, SumoProcess* child);
  /// A connection that is open already and stays its owner's: it is left open.
  explicit TraciClient(int socket) : fd_(socket), owned_(false), child_(nullptr) {}
  ~TraciClient();
  TraciClient(const TraciClient&) = delete;
  TraciClient& operator=(const TraciClient&) = delete;

  /// Sends the message and waits up to `timeout` seconds (Deadline) for its reply, whose bytes
  /// (without the length in front) stay valid until the next call. Throws SumoError where SUMO goes
  /// away, hangs or speaks nonsense; the connection is then closed and further calls throw at once.
  std::span<const std::uint8_t> exchange(TraciWriter& message, double timeout);

  bool connected() const { return fd_ >= 0; }
  /// The last failure was an answer that did not come in time.
  bool timed_out() const { return timed_out_; }
  void close();

 private:
  void send_all(std::span<const std::uint8_t> bytes, Deadline& deadline);
  void receive(std::size_t bytes, Deadline& deadline);
  /// Waits for the socket; drains the child's output meanwhile.
  void wait_for(short events, Deadline& deadline);
  [[noreturn]] void fail(const std::string& what);

  int fd_ = -1;
  bool owned_ = true;
  bool timed_out_ = false;
  std::string where_;
  SumoProcess* child_;
  std::vector<std::uint8_t> reply_;
};

}  // namespace sumogamma
