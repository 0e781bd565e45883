#include "base/piped_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <utility>

#include "base/error.h"

namespace sumogamma {

namespace {

/// The last lines of a log, on one.
std::string end_of(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::ostringstream all;
  all << file.rdbuf();
  std::string text = all.str();
  constexpr std::size_t kMost = 300;
  if (text.size() > kMost) text = text.substr(text.size() - kMost);
  for (char& letter : text)
    if (letter == '\n') letter = ' ';
  return text;
}

}  // namespace

PipedProcess::PipedProcess(Request request) : request_(std::move(request)) {
  Spawn program;
  program.log_into(request_.log);
  program.give(to_.read_end, request_.input);
  if (request_.output >= 0) program.give(from_.write_end, request_.output);
  pid_ = program.start(request_.arguments);
  to_.close_read();
  from_.close_write();
}

PipedProcess::~PipedProcess() {
  close_pipes();
  // whoever reads nothing more ends by itself mostly
  if (wait_for_end(1.0)) return;
  kill(-pid_, SIGTERM);
  if (wait_for_end(2.0)) return;
  kill(-pid_, SIGKILL);
  while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
  }
}

void PipedProcess::close_pipes() {
  to_.close_write();
  from_.close_read();
}

bool PipedProcess::wait_for_end(double seconds) {
  for (int i = 0; !ended_ && i < static_cast<int>(seconds * 100.0); ++i) {
    if (waitpid(pid_, &status_, WNOHANG) == pid_) ended_ = true;
    if (!ended_) usleep(10000);
  }
  return ended_;
}

void PipedProcess::fail(const std::string& what) const {
  throw Error(request_.arguments[0], what + "; it said: " + end_of(request_.log));
}

void PipedProcess::write(std::string_view bytes) {
  fcntl(to_.write_end, F_SETFL, O_NONBLOCK);
  while (!bytes.empty()) {
    pollfd wait{to_.write_end, POLLOUT, 0};
    if (poll(&wait, 1, static_cast<int>(request_.patience * 1000.0)) == 0)
      fail("takes nothing more");
    const ssize_t count = ::write(to_.write_end, bytes.data(), bytes.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count < 0) fail("went away");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::string PipedProcess::read_until(char end) {
  std::size_t looked_at = 0;
  for (;;) {
    if (const std::size_t at = unread_.find(end, looked_at); at != std::string::npos) {
      std::string message = unread_.substr(0, at);
      unread_.erase(0, at + 1);
      return message;
    }
    looked_at = unread_.size();
    pollfd wait{from_.read_end, POLLIN, 0};
    if (poll(&wait, 1, static_cast<int>(request_.patience * 1000.0)) == 0) fail("says nothing");
    std::array<char, 65536> block{};
    const ssize_t count = ::read(from_.read_end, block.data(), block.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) fail("went away");
    unread_.append(block.data(), static_cast<std::size_t>(count));
  }
}

int PipedProcess::finish() {
  close_pipes();
  if (!wait_for_end(request_.patience)) fail("doesn't come to its end");
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
}

}  // namespace sumogamma
