#include "base/piped_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "base/error.h"

namespace sumogamma {

namespace {

/// A pipe's two ends, not inherited, above any descriptor that a child is to have.
std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error("pipe", std::strerror(errno));
  constexpr int kAbove = 10;
  for (int& end : ends) {
    const int higher = fcntl(end, F_DUPFD_CLOEXEC, kAbove);
    close(end);
    end = higher;
  }
  return ends;
}

void close_end(int& end) {
  if (end >= 0) close(end);
  end = -1;
}

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
  std::array<int, 2> in = make_pipe(), out{-1, -1};
  if (request_.output >= 0) out = make_pipe();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, request_.log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&actions, in[0], request_.input);
  if (request_.output >= 0) posix_spawn_file_actions_adddup2(&actions, out[1], request_.output);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD}) sigaddset(&defaults, number);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> words;
  for (std::string& word : request_.arguments) words.push_back(word.data());
  words.push_back(nullptr);
  const int failure = posix_spawnp(&pid_, words[0], &actions, &attributes, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close_end(in[0]);
  close_end(out[1]);
  to_ = in[1];
  from_ = out[0];
  if (failure == 0) return;
  close_pipes();
  throw Error(request_.arguments[0], std::string("cannot be started: ") + std::strerror(failure));
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
  close_end(to_);
  close_end(from_);
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
  fcntl(to_, F_SETFL, O_NONBLOCK);
  while (!bytes.empty()) {
    pollfd wait{to_, POLLOUT, 0};
    if (poll(&wait, 1, static_cast<int>(request_.patience * 1000.0)) == 0)
      fail("takes nothing more");
    const ssize_t count = ::write(to_, bytes.data(), bytes.size());
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
    pollfd wait{from_, POLLIN, 0};
    if (poll(&wait, 1, static_cast<int>(request_.patience * 1000.0)) == 0) fail("says nothing");
    std::array<char, 65536> block{};
    const ssize_t count = ::read(from_, block.data(), block.size());
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
