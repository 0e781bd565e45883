#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sumo/traci_message.h"

namespace sumogamma {

/// Speaks just enough TraCI on 127.0.0.1 for a back end to start and step, and lies where a test
/// tells it to.
class FakeSumoServer {
 public:
  using Bytes = std::vector<std::uint8_t>;
  enum class Then { Send, SendAndClose, Close, Hang };
  /// Called with the number of the message (0: the handshake's version, 1 and 2: its lists and
  /// subscriptions, 3: the first step) and the whole honest reply, length included, to spoil.
  using Spoil = std::function<Then(int message, Bytes& reply)>;

  std::int32_t protocol = 20;
  std::vector<std::string> signals;
  std::set<std::string> refused;     ///< ids whose commands are answered with an error status
  std::string lane;                  ///< that every vehicle says to be on
  std::atomic<int> keep_route = -1;  ///< of the last ghost

  explicit FakeSumoServer(Spoil spoil = nullptr) : spoil_(std::move(spoil)) {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
        listen(listener_, 1) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("the fake server can't listen");
    port_ = ntohs(address.sin_port);
  }
  ~FakeSumoServer() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    if (client_ >= 0) ::close(client_);
    ::close(listener_);
  }
  FakeSumoServer(const FakeSumoServer&) = delete;
  FakeSumoServer& operator=(const FakeSumoServer&) = delete;

  /// Serves one client from now on, in a thread; set the fields first.
  void serve() {
    thread_ = std::thread([this] { run(); });
  }
  int port() const { return port_; }
  int messages() const { return messages_; }

  static void put_integer(Bytes& bytes, std::int32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
      bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> shift));
  }
  static void put_double(Bytes& bytes, double value) {
    for (int shift = 56; shift >= 0; shift -= 8)
      bytes.push_back(static_cast<std::uint8_t>(std::bit_cast<std::uint64_t>(value) >> shift));
  }
  static void put_string(Bytes& bytes, const std::string& value) {
    put_integer(bytes, static_cast<std::int32_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
  }

 private:
  bool readable(int fd) {
    while (!stop_) {
      pollfd wait{fd, POLLIN, 0};
      if (poll(&wait, 1, 20) > 0) return true;
    }
    return false;
  }
  bool receive(std::uint8_t* bytes, std::size_t count) {
    while (count > 0) {
      if (!readable(client_)) return false;
      const ssize_t got = recv(client_, bytes, count, 0);
      if (got <= 0) return false;
      bytes += got;
      count -= static_cast<std::size_t>(got);
    }
    return true;
  }
  void run() {
    if (!readable(listener_)) return;
    client_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    std::uint8_t header[4];
    while (receive(header, 4)) {
      const std::size_t length = static_cast<std::size_t>(TraciReader({header, 4}).integer());
      Bytes request(length - 4);
      if (!receive(request.data(), request.size())) return;
      Bytes reply = answer(request);
      const Then then = spoil_ ? spoil_(messages_, reply) : Then::Send;
      ++messages_;
      if (then == Then::Hang) continue;
      if (then != Then::Close) send(client_, reply.data(), reply.size(), MSG_NOSIGNAL);
      if (then != Then::Send) {
        ::shutdown(client_, SHUT_RDWR);
        return;
      }
    }
  }

  static void status(Bytes& reply, std::uint8_t command, std::uint8_t result,
                     const std::string& text) {
    reply.push_back(static_cast<std::uint8_t>(7 + text.size()));
    reply.push_back(command);
    reply.push_back(result);
    put_string(reply, text);
  }
  static void block(Bytes& reply, const Bytes& body) {
    reply.push_back(0);
    put_integer(reply, static_cast<std::int32_t>(body.size() + 5));
    reply.insert(reply.end(), body.begin(), body.end());
  }
  void value(Bytes& body, std::uint8_t domain, std::uint8_t variable) const {
    using namespace traci;
    if (variable == kIdList || (domain == kSimulation && variable >= 0x25 && variable <= 0x27) ||
        (domain == kSimulation && (variable == kDepartedVehicles || variable == kArrivedVehicles ||
                                   variable == kPendingVehicles))) {
      const bool listed = domain == kTrafficLight;
      body.push_back(kTypeStringList);
      put_integer(body, listed ? static_cast<std::int32_t>(signals.size()) : 0);
      if (listed)
        for (const std::string& signal : signals) put_string(body, signal);
    } else if ((domain == kSimulation && variable != kTime && variable != kOption) ||
               variable == kStopState || variable == kStagesLeft || variable == kRouteIndex) {
      body.push_back(kTypeInteger);
      put_integer(body, 0);
    } else if (domain == kTrafficLight || variable == kOption || variable == kLane ||
               variable == kRidesIn || variable == kParameter) {
      body.push_back(kTypeString);
      put_string(body, domain == kTrafficLight ? "rG" : variable == kLane ? lane : "");
    } else if (variable == kEdges) {
      body.push_back(kTypeStringList);
      put_integer(body, 0);
    } else if (variable == kPosition) {
      body.push_back(kTypePosition2d);
      put_double(body, ghost_x_);
      put_double(body, ghost_y_);
    } else {
      body.push_back(kTypeDouble);
      put_double(body, domain == kSimulation ? time_ : ghost_angle_);
    }
  }
  void subscription(Bytes& reply, std::uint8_t domain, const std::string& id,
                    const std::vector<std::uint8_t>& variables) const {
    Bytes body = {traci::subscribe_response(domain)};
    put_string(body, id);
    body.push_back(static_cast<std::uint8_t>(variables.size()));
    for (const std::uint8_t variable : variables) {
      body.push_back(variable);
      body.push_back(traci::kOk);
      value(body, domain, variable);
    }
    block(reply, body);
  }
  // an honest SUMO's reply to a message of any commands
  Bytes answer(std::span<const std::uint8_t> request) {
    Bytes reply(4, 0);
    while (!request.empty()) {
      TraciReader header(request);
      const std::size_t before = header.remaining();
      const std::size_t length = header.block_length();
      const std::size_t header_size = before - header.remaining();
      command(reply, request.subspan(header_size, length));
      request = request.subspan(header_size + length);
    }
    Bytes total;
    put_integer(total, static_cast<std::int32_t>(reply.size()));
    std::copy(total.begin(), total.end(), reply.begin());
    return reply;
  }
  void command(Bytes& reply, std::span<const std::uint8_t> bytes) {
    TraciReader body(bytes);
    const std::uint8_t id = body.byte();
    if (id == traci::kGetVersion) {
      status(reply, id, traci::kOk, "");
      Bytes version = {id};
      put_integer(version, protocol);
      put_string(version, "SUMO fake");
      block(reply, version);
    } else if (id == traci::kSimulationStep) {
      time_ += 0.1;
      status(reply, id, traci::kOk, "");
      put_integer(reply, static_cast<std::int32_t>(subscribed_.size()));
      for (const auto& [domain, object, variables] : subscribed_)
        subscription(reply, domain, object, variables);
    } else if (id == traci::kClose) {
      status(reply, id, traci::kOk, "");
    } else if (id >= 0xd0 && id < 0xe0) {
      body.real();
      body.real();
      const std::string object = body.string();
      std::vector<std::uint8_t> variables(body.byte());
      for (std::uint8_t& variable : variables) variable = body.byte();
      const auto domain = static_cast<std::uint8_t>(id - 0x30);
      subscribed_.push_back({domain, object, variables});
      status(reply, id, traci::kOk, "");
      subscription(reply, domain, object, variables);
    } else {
      object_command(reply, id, body);
    }
  }
  void object_command(Bytes& reply, std::uint8_t id, TraciReader& body) {
    const std::uint8_t variable = body.byte();
    const std::string object = body.string();
    if (refused.count(object) != 0) {
      status(reply, id, traci::kRefused, "'" + object + "' is not known");
      return;
    }
    status(reply, id, traci::kOk, "");
    if (id >= 0xc0) {  // a set command
      if (variable == traci::kMoveToXy)
        remember_ghost(body, id == traci::set_command(traci::kPerson));
      return;
    }
    Bytes answer_body = {traci::get_response(id), variable};
    put_string(answer_body, object);
    value(answer_body, id, variable);
    block(reply, answer_body);
  }
  void remember_ghost(TraciReader& body, bool is_person) {
    body.compound();
    body.typed_string();
    if (!is_person) body.typed_integer();
    ghost_x_ = body.typed_double();
    ghost_y_ = body.typed_double();
    ghost_angle_ = body.typed_double();
    body.byte();
    keep_route = body.byte();
  }

  struct Subscribed {
    std::uint8_t domain;
    std::string object;
    std::vector<std::uint8_t> variables;
  };

  Spoil spoil_;
  int listener_ = -1, client_ = -1, port_ = 0;
  std::atomic<bool> stop_ = false;
  std::atomic<int> messages_ = 0;
  double time_ = 0, ghost_x_ = 0, ghost_y_ = 0, ghost_angle_ = 0;
  std::vector<Subscribed> subscribed_;
  std::thread thread_;
};

}  // namespace sumogamma
