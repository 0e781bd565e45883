#include "ego/ego_socket.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "base/error.h"

namespace sumogamma {

namespace {

using Clock = std::chrono::steady_clock;

double left_until(Clock::time_point end) {
  return std::chrono::duration<double>(end - Clock::now()).count();
}

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::min(seconds, 1e8)));
}

/// True once something can be read or written (`events`); false where time is up.
bool wait_for(int descriptor, short events, Clock::time_point end, const StopAsked& stop) {
  constexpr double kSlice = 0.2;  // between two looks whether to stop [s]
  for (;;) {
    const double left = std::max(left_until(end), 0.0);
    pollfd one{descriptor, events, 0};
    const int ready = poll(&one, 1, static_cast<int>(1000.0 * std::min(left, kSlice)) + 1);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return true;  // the call that follows says what is wrong
    if (left <= 0.0 || (stop && stop())) return false;
  }
}

[[noreturn]] void refuse(const std::string& address, const std::string& what) {
  throw Error("--ego " + address.substr(0, 120), what);
}

}  // namespace

EgoConnection::~EgoConnection() { close(descriptor_); }

Received EgoConnection::receive(double seconds, const StopAsked& stop) {
  constexpr std::size_t kHead = 4;
  const Clock::time_point end = after(seconds);
  for (;;) {
    if (buffer_.size() >= kHead) {
      std::size_t length = 0;
      for (std::size_t k = 0; k < kHead; ++k)
        length = length << 8 | static_cast<unsigned char>(buffer_[k]);
      if (length == 0 || length > kLongestMessage)
        return {Received::Kind::Bad, "a length of " + std::to_string(length) +
                                         " bytes, expected 1 to " +
                                         std::to_string(kLongestMessage)};
      if (buffer_.size() >= kHead + length) {
        Received message{Received::Kind::Message, buffer_.substr(kHead, length)};
        buffer_.erase(0, kHead + length);
        return message;
      }
    }
    if (!wait_for(descriptor_, POLLIN, end, stop)) return {Received::Kind::Late, {}};
    char chunk[4096];
    const ssize_t count = recv(descriptor_, chunk, sizeof chunk, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      return {buffer_.empty() ? Received::Kind::Closed : Received::Kind::Bad,
              "it ended amid a message"};
    buffer_.append(chunk, static_cast<std::size_t>(count));
  }
}

bool EgoConnection::send(std::string_view bytes, double seconds) {
  const Clock::time_point end = after(seconds);
  std::string whole;
  for (int shift = 24; shift >= 0; shift -= 8)
    whole.push_back(static_cast<char>(bytes.size() >> shift & 0xff));
  whole.append(bytes);
  std::string_view left = whole;
  while (!left.empty()) {
    if (!wait_for(descriptor_, POLLOUT, end, {})) return false;
    const ssize_t count =
        ::send(descriptor_, left.data(), left.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) return false;
    left.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

EgoListener::EgoListener(const std::string& address, bool anywhere) : address_(address) {
  if (address.rfind("unix:", 0) == 0) {
    listen_at_path(address.substr(5));
    return;
  }
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == address.size())
    refuse(address, "is neither unix:PATH nor HOST:PORT");
  listen_at_port(address.substr(0, colon), address.substr(colon + 1), anywhere);
}

EgoListener::~EgoListener() {
  if (descriptor_ >= 0) close(descriptor_);
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove(path_, ignored);
}

void EgoListener::listen_at_path(const std::string& path) {
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof place.sun_path)
    refuse(address_, "a path of 1 to " + std::to_string(sizeof place.sun_path - 1) + " bytes");
  struct stat there {};
  if (lstat(path.c_str(), &there) == 0) {
    if (!S_ISSOCK(there.st_mode)) refuse(address_, "is there already and no socket");
    unlink(path.c_str());  // left behind by who was killed
  }
  std::memcpy(place.sun_path, path.c_str(), path.size() + 1);
  descriptor_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto* const where = reinterpret_cast<const sockaddr*>(&place);
  if (descriptor_ < 0 || bind(descriptor_, where, sizeof place) != 0 ||
      listen(descriptor_, 4) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor_ >= 0) close(descriptor_);
    refuse(address_, "can't be listened at (" + why + ")");
  }
  path_ = path;
}

void EgoListener::listen_at_port(const std::string& host, const std::string& port, bool anywhere) {
  addrinfo wish{};
  wish.ai_family = AF_INET;
  wish.ai_socktype = SOCK_STREAM;
  wish.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), port.c_str(), &wish, &found) != 0 || found == nullptr)
    refuse(address_, "is no HOST:PORT that can be found");
  sockaddr_in place{};
  std::memcpy(&place, found->ai_addr, sizeof place);
  freeaddrinfo(found);
  const bool is_loopback = ntohl(place.sin_addr.s_addr) >> 24 == 127;
  if (!is_loopback && !anywhere)
    refuse(address_,
           "is not on this machine's loopback: whoever reaches it could drive; give "
           "--ego-anywhere where that is meant");
  descriptor_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  auto* const where = reinterpret_cast<sockaddr*>(&place);
  socklen_t size = sizeof place;
  if (descriptor_ < 0 || bind(descriptor_, where, size) != 0 || listen(descriptor_, 4) != 0 ||
      getsockname(descriptor_, where, &size) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor_ >= 0) close(descriptor_);
    refuse(address_, "can't be listened at (" + why + ")");
  }
  address_ = host + ":" + std::to_string(ntohs(place.sin_port));
}

std::unique_ptr<EgoConnection> EgoListener::accept(double seconds, const StopAsked& stop) {
  if (!wait_for(descriptor_, POLLIN, after(seconds), stop)) return nullptr;
  const int joined = accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC);
  if (joined < 0) return nullptr;
  const int yes = 1;
  setsockopt(joined, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);  // of no use to a unix socket
  return std::make_unique<EgoConnection>(joined);
}

}  // namespace sumogamma
