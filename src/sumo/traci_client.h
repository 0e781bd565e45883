#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sumo/sumo_process.h"
#include "sumo/traci_message.h"

namespace sumogamma {

/// One TCP connection to a SUMO: a message out, its reply in. It never blocks for longer than
/// asked, never raises SIGPIPE, and notices within a tenth of a second when the child has died.
class TraciClient {
 public:
  /// Connects within `timeout` seconds. Where nobody listens it keeps trying until the child ends;
  /// without one (null) it gives up within two seconds. Throws SumoError.
  TraciClient(const std::string& host, int port, double timeout, SumoProcess* child);
  /// A connection that is open already and stays its owner's: it is left open.
  explicit TraciClient(int socket) : fd_(socket), owned_(false), child_(nullptr) {}
  ~TraciClient();
  TraciClient(const TraciClient&) = delete;
  TraciClient& operator=(const TraciClient&) = delete;

  /// Sends the message and waits up to `timeout` seconds for its reply, whose bytes (without the
  /// length in front) stay valid until the next call. Throws SumoError where SUMO goes away, hangs
  /// or speaks nonsense; the connection is then closed and further calls throw at once.
  std::span<const std::uint8_t> exchange(TraciWriter& message, double timeout);

  bool connected() const { return fd_ >= 0; }
  /// The last failure was an answer that did not come in time.
  bool timed_out() const { return timed_out_; }
  void close();

 private:
  void send_all(std::span<const std::uint8_t> bytes, double deadline);
  void receive(std::size_t bytes, double deadline);
  /// Waits for the socket; drains the child's output meanwhile.
  void wait_for(short events, double deadline);
  [[noreturn]] void fail(const std::string& what);

  int fd_ = -1;
  bool owned_ = true;
  bool timed_out_ = false;
  std::string where_;
  SumoProcess* child_;
  std::vector<std::uint8_t> reply_;
};

}  // namespace sumogamma
