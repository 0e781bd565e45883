#include "sumo/traci_client.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <system_error>
#include <thread>

#include "base/error.h"

namespace sumogamma {
namespace {

// 100,000 agents answer with some 20 MB: anything far beyond is a lie
constexpr std::size_t kLargestReply = std::size_t{512} << 20;
constexpr std::size_t kFirstAllocation = std::size_t{1} << 20;
constexpr int kSliceMs = 100;
constexpr double kRefusalPatience = 1.0;  // where somebody else's SUMO should be listening [s]

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses resolve(const std::string& host, int port) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  int result = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  // containers without an /etc/hosts
  if (result != 0 && host == "localhost")
    result = getaddrinfo("127.0.0.1", std::to_string(port).c_str(), &hints, &found);
  if (result != 0)
    throw SumoError(host + ":" + std::to_string(port),
                    std::string("unknown host: ") + gai_strerror(result));
  return {found, &freeaddrinfo};
}

// a connected socket, or -1 with errno
int try_connect(const addrinfo& address, Deadline& deadline) {
  const int fd = socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return -1;
  int error = 0;
  if (connect(fd, address.ai_addr, address.ai_addrlen) != 0) error = errno;
  while (error == EINPROGRESS && deadline.left() > 0) {
    pollfd wait{fd, POLLOUT, 0};
    if (poll(&wait, 1, kSliceMs) > 0) {
      socklen_t size = sizeof error;
      getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
    }
  }
  if (error == 0) {
    const int on = 1;
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return fd;
  }
  close(fd);
  errno = error == EINPROGRESS ? ETIMEDOUT : error;
  return -1;
}

}  // namespace

Deadline::Deadline(double timeout, const SumoProcess* child)
    : child_(child),
      timeout_(timeout),
      end_(now() + timeout),
      cpu_before_(child != nullptr ? child->cpu_seconds() : 0.0) {}

double Deadline::left() {
  const double left = end_ - now();
  if (left > 0 || child_ == nullptr || delays_ == kMostDelays) return left;
  const double cpu = child_->cpu_seconds();
  if (cpu - cpu_before_ < kBusyShare * timeout_) return left;
  cpu_before_ = cpu;
  ++delays_;
  end_ = now() + timeout_;
  return timeout_;
}

TraciClient::TraciClient(const std::string& host, int port, double timeout, SumoProcess* child)
    : where_(host + ":" + std::to_string(port)), child_(child) {
  const Addresses addresses = resolve(host, port);
  Deadline deadline(timeout, child_);
  const double refused = now() + kRefusalPatience;
  int reason = ECONNREFUSED;
  while (true) {
    for (const addrinfo* address = addresses.get(); address != nullptr;
         address = address->ai_next) {
      fd_ = try_connect(*address, deadline);
      if (fd_ >= 0) return;
      reason = errno;
    }
    if (child_ != nullptr) {
      child_->drain();
      if (!child_->running()) throw SumoError("SUMO", "ended while it was starting");
    }
    // a child that loads its network isn't there yet; where nobody listens nobody may ever
    const bool nobody = child_ == nullptr && reason == ECONNREFUSED && now() >= refused;
    if (nobody || deadline.left() <= 0)
      throw SumoError(where_, "no connection to SUMO: " + std::generic_category().message(reason));
    std::this_thread::sleep_for(std::chrono::milliseconds(child_ != nullptr ? 10 : 50));
  }
}

TraciClient::~TraciClient() { close(); }

void TraciClient::close() {
  if (fd_ >= 0 && owned_) ::close(fd_);
  fd_ = -1;
}

void TraciClient::fail(const std::string& what) {
  close();
  throw SumoError("SUMO", what);
}

void TraciClient::wait_for(short events, Deadline& deadline) {
  while (true) {
    const double left = deadline.left();
    timed_out_ = left <= 0;
    if (timed_out_) fail("no answer within the time limit; it hangs or is stopped");
    pollfd fds[2] = {{fd_, events, 0}, {child_ != nullptr ? child_->output_fd() : -1, POLLIN, 0}};
    const int ready = poll(fds, 2, std::min(kSliceMs, static_cast<int>(left * 1000) + 1));
    if (ready > 0 && fds[1].revents != 0) child_->drain();
    if (ready > 0 && fds[0].revents != 0) return;
    // checked behind the socket: a reply that is already there counts even if SUMO died behind it
    if (ready == 0 && child_ != nullptr && !child_->running()) fail("the process ended");
  }
}

void TraciClient::send_all(std::span<const std::uint8_t> bytes, Deadline& deadline) {
  while (!bytes.empty()) {
    const ssize_t sent = send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      wait_for(POLLOUT, deadline);
    } else if (errno != EINTR) {
      fail("the connection broke: " + std::generic_category().message(errno));
    }
  }
}

void TraciClient::receive(std::size_t bytes, Deadline& deadline) {
  // grow with what really arrives: a length that lies must not make us allocate
  std::size_t have = 0;
  reply_.resize(std::max(reply_.size(), std::min(bytes, kFirstAllocation)));
  while (have < bytes) {
    if (have == reply_.size()) reply_.resize(std::min(bytes, 2 * reply_.size()));
    const std::size_t room = std::min(bytes, reply_.size()) - have;
    const ssize_t got = recv(fd_, reply_.data() + have, room, MSG_DONTWAIT);
    if (got > 0) {
      have += static_cast<std::size_t>(got);
    } else if (got == 0) {
      fail("it closed the connection");
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      wait_for(POLLIN, deadline);
    } else if (errno != EINTR) {
      fail("the connection broke: " + std::generic_category().message(errno));
    }
  }
}

std::span<const std::uint8_t> TraciClient::exchange(TraciWriter& message, double timeout) {
  if (fd_ < 0) throw SumoError("SUMO", "the connection is closed");
  Deadline deadline(timeout, child_);
  constexpr std::size_t kHeader = 4;
  send_all(message.frame(), deadline);
  receive(kHeader, deadline);
  const std::size_t length =
      static_cast<std::uint32_t>(TraciReader({reply_.data(), kHeader}).integer());
  if (length < kHeader || length > kLargestReply)
    fail("broken reply over TraCI: a message length of " + std::to_string(length) +
         "; is the other side a SUMO?");
  receive(length - kHeader, deadline);
  return {reply_.data(), length - kHeader};
}

}  // namespace sumogamma
