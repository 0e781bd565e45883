#include "base/subprocess.h"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/spawn.h"

namespace sumogamma {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kPollMs = 100;
constexpr double kTermGrace = 2.0;  // [s] between SIGTERM and SIGKILL

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

pid_t spawn(const ProcessRequest& request, const Pipe& out, const Pipe& err) {
  Spawn program;
  if (request.log.empty()) {
    program.give(out.write_end, STDOUT_FILENO);
    program.give(err.write_end, STDERR_FILENO);
  } else {
    program.log_into(request.log);
  }
  if (!request.folder.empty()) program.run_in(request.folder);
  return program.start(request.arguments, request.environment);
}

/// Process groups of the children that run now.
std::mutex running_mutex;
std::set<pid_t> running;

/// Owns the running child: whatever happens, it has ended and been reaped when this goes.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {
    const std::scoped_lock lock(running_mutex);
    running.insert(pid_);
  }
  ~Child() {
    if (!reaped_) end();
    const std::scoped_lock lock(running_mutex);
    running.erase(pid_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// True once it has ended; does not wait.
  bool ended() {
    if (!reaped_ && waitpid(pid_, &status_, WNOHANG) == pid_) reaped_ = true;
    return reaped_;
  }
  void end() {
    kill(-pid_, SIGTERM);
    const Clock::time_point start = Clock::now();
    while (!ended() && seconds_since(start) < kTermGrace) usleep(10000);
    kill(-pid_, SIGKILL);
    while (!reaped_) {
      if (waitpid(pid_, &status_, 0) == pid_ || errno != EINTR) reaped_ = true;
    }
  }
  int status() const { return status_; }

 private:
  pid_t pid_;
  int status_ = 0;
  bool reaped_ = false;
};

/// Appends what is ready; false at the stream's end.
bool read_some(int descriptor, std::string& text, std::size_t limit) {
  std::array<char, 65536> block{};
  const ssize_t count = read(descriptor, block.data(), block.size());
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  if (count == 0) return false;
  const std::size_t room = limit > text.size() ? limit - text.size() : 0;
  text.append(block.data(), std::min(static_cast<std::size_t>(count), room));
  return true;
}

void gather(const ProcessRequest& request, Pipe& out, Pipe& err, Child& child,
            ProcessResult& result) {
  const Clock::time_point start = Clock::now();
  Clock::time_point end_seen{};
  while (out.read_end >= 0 || err.read_end >= 0) {
    std::array<pollfd, 2> waits{{{out.read_end, POLLIN, 0}, {err.read_end, POLLIN, 0}}};
    const int ready = poll(waits.data(), waits.size(), kPollMs);
    if (ready > 0) {
      if (waits[0].revents != 0 && !read_some(out.read_end, result.output, request.output_limit))
        out.close_read();
      if (waits[1].revents != 0 && !read_some(err.read_end, result.errors, request.output_limit))
        err.close_read();
    }
    result.stopped = request.should_stop && request.should_stop();
    result.timed_out = !result.stopped && seconds_since(start) > request.time_limit;
    if (result.stopped || result.timed_out) return child.end();
    // a grandchild may keep the streams open: its parent's end is the program's end
    if (child.ended() && ready == 0) {
      if (end_seen == Clock::time_point{}) end_seen = Clock::now();
      if (seconds_since(end_seen) > 1.0) return;
    }
  }
  while (!child.ended()) {
    result.stopped = request.should_stop && request.should_stop();
    result.timed_out = !result.stopped && seconds_since(start) > request.time_limit;
    if (result.stopped || result.timed_out) return child.end();
    usleep(1000);
  }
}

}  // namespace

ProcessResult run_process(const ProcessRequest& request) {
  if (request.arguments.empty()) throw Error("run_process", "no program given");
  ProcessResult result;
  Pipe out, err;
  Child child(spawn(request, out, err));
  out.close_write();
  err.close_write();
  gather(request, out, err, child, result);
  if (!child.ended()) child.end();
  if (WIFSIGNALED(child.status()))
    result.signal = WTERMSIG(child.status());
  else
    result.exit_code = WEXITSTATUS(child.status());
  return result;
}

void kill_running_processes() noexcept {
  const std::scoped_lock lock(running_mutex);
  for (const pid_t pid : running) kill(-pid, SIGKILL);
}

std::string describe_end(const ProcessResult& result, double time_limit) {
  if (result.stopped) return "stopped on request";
  if (result.timed_out)
    return "no end after " + std::to_string(static_cast<long>(time_limit)) + " s";
  if (result.signal != 0)
    return "killed by signal " + std::to_string(result.signal) + " (" + strsignal(result.signal) +
           ")";
  return "exit code " + std::to_string(result.exit_code);
}

std::filesystem::path own_program() { return std::filesystem::read_symlink("/proc/self/exe"); }

std::filesystem::path find_program(const std::string& name) {
  std::vector<std::filesystem::path> folders;
  if (const char* home = std::getenv("SUMO_HOME"); home != nullptr && *home != '\0')
    folders.push_back(std::filesystem::path(home) / "bin");
  if (const char* path = std::getenv("PATH")) {
    std::string_view rest(path);
    while (!rest.empty()) {
      const std::size_t colon = rest.find(':');
      folders.emplace_back(rest.substr(0, colon));
      rest = colon == std::string_view::npos ? std::string_view() : rest.substr(colon + 1);
    }
  }
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path candidate = folder / name;
    if (!folder.empty() && access(candidate.c_str(), X_OK) == 0 &&
        std::filesystem::is_regular_file(candidate))
      return candidate;
  }
  return {};
}

}  // namespace sumogamma
