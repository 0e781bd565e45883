#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace sumogamma {

/// Longest message that is taken from the other side [bytes].
inline constexpr std::size_t kLongestMessage = 65536;

/// A message, or why there is none.
struct Received {
  enum class Kind : std::uint8_t { Message, Late, Closed, Bad };
  Kind kind = Kind::Late;
  std::string bytes;  ///< of the message without its length; of Bad: what is wrong
};

/// Asked every now and then while waiting: is the program to end?
using StopAsked = std::function<bool()>;

/// One that has joined. Every message has its length before it: four bytes, the highest first.
class EgoConnection {
 public:
  explicit EgoConnection(int descriptor) : descriptor_(descriptor) {}
  ~EgoConnection();
  EgoConnection(const EgoConnection&) = delete;
  EgoConnection& operator=(const EgoConnection&) = delete;

  /// Waits `seconds` at the most; what has come of an unfinished message is kept for the next call.
  /// A length of 0 or above kLongestMessage is Bad before anything of it is read.
  Received receive(double seconds, const StopAsked& stop);
  /// False where the other side is gone or takes nothing for `seconds`.
  bool send(std::string_view bytes, double seconds);

 private:
  int descriptor_;
  std::string buffer_;
};

/// Where an ego may join: "unix:PATH" or "HOST:PORT" (loopback alone, unless `anywhere`).
class EgoListener {
 public:
  /// Throws Error naming --ego where the address is none, or can't be listened at.
  EgoListener(const std::string& address, bool anywhere);
  ~EgoListener();
  EgoListener(const EgoListener&) = delete;
  EgoListener& operator=(const EgoListener&) = delete;

  /// The next one that joins within `seconds`; null: nobody.
  std::unique_ptr<EgoConnection> accept(double seconds, const StopAsked& stop);
  /// As it is written for a client; with the port that was chosen for port 0.
  const std::string& address() const { return address_; }

 private:
  void listen_at_path(const std::string& path);
  void listen_at_port(const std::string& host, const std::string& port, bool anywhere);

  int descriptor_ = -1;
  std::string address_;
  std::filesystem::path path_;  ///< of the socket, to be removed
};

}  // namespace sumogamma
