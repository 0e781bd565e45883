#include "sumo/sumo_process.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/subprocess.h"

namespace sumogamma {
namespace {

constexpr std::size_t kKeptLines = 40;
constexpr std::size_t kLongestLine = 4096;
constexpr long kWarningsTold = 10;
constexpr const char* kDebianSumoHome = "/usr/share/sumo";

// the environment of the child: ours, with SUMO_HOME (its tools and schemas) where the user has not
// set it
std::vector<std::string> child_environment() {
  std::vector<std::string> environment;
  bool has_home = false;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    environment.emplace_back(*entry);
    has_home = has_home || environment.back().rfind("SUMO_HOME=", 0) == 0;
  }
  if (!has_home && std::filesystem::is_directory(kDebianSumoHome))
    environment.push_back(std::string("SUMO_HOME=") + kDebianSumoHome);
  return environment;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  result.reserve(strings.size() + 1);
  for (std::string& string : strings) result.push_back(string.data());
  result.push_back(nullptr);
  return result;
}

// between fork and exec: async-signal-safe calls alone
[[noreturn]] void become_child(char* const* arguments, char* const* environment, int output,
                               int error_pipe, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent died before prctl
  setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGHUP}) signal(number, SIG_DFL);
  const int null = open("/dev/null", O_RDONLY);
  if (null >= 0) dup2(null, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  // our open result files are no business of SUMO's (the flag marks them close-on-exec, the error
  // pipe included)
  constexpr unsigned kCloseOnExec = 4;
  syscall(SYS_close_range, 3U, UINT_MAX, kCloseOnExec);
  execve(arguments[0], arguments, environment);
  const int reason = errno;
  [[maybe_unused]] const ssize_t written = write(error_pipe, &reason, sizeof reason);
  _exit(127);
}

}  // namespace

std::string find_sumo_binary(const std::string& name) {
  // a path is taken as it is, relative to where we are; a bare name is looked up
  const std::filesystem::path found =
      name.find('/') == std::string::npos ? find_program(name) : std::filesystem::path(name);
  if (found.empty() || access(found.c_str(), X_OK) != 0 || std::filesystem::is_directory(found))
    throw Error(
        name,
        "not found in $SUMO_HOME/bin nor in PATH; install SUMO (tools/setup.sh) or set SUMO_HOME");
  return found.string();
}

void set_default_sumo_home() {
  if (std::filesystem::is_directory(kDebianSumoHome)) setenv("SUMO_HOME", kDebianSumoHome, 0);
}

int free_port() {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool found = fd >= 0 &&
                     bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                     getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  if (fd >= 0) close(fd);
  if (!found)
    throw SumoError("SUMO",
                    "no free TCP port on 127.0.0.1: " + std::generic_category().message(errno));
  return ntohs(address.sin_port);
}

void SumoOutput::append(std::string_view text) {
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      if (!partial_.empty()) add_line(std::move(partial_));
      partial_.clear();
    } else if (partial_.size() < kLongestLine) {
      partial_.push_back(c);
    }
  }
}

void SumoOutput::add_line(std::string line) {
  constexpr std::string_view kError = "Error:", kWarning = "Warning:";
  const bool indented = line.front() == ' ' || line.front() == '\t';
  const std::size_t begin = line.find_first_not_of(" \t");
  if (line.rfind(kWarning, 0) == 0 && ++warnings_ <= kWarningsTold) {
    const std::size_t text = line.find_first_not_of(' ', kWarning.size());
    first_warnings_.push_back(text == std::string::npos ? line : line.substr(text));
  }
  if (error_open_ && indented && begin != std::string::npos && first_error_.size() < kLongestLine) {
    first_error_ += " " + line.substr(begin);
  } else {
    error_open_ = false;
  }
  if (first_error_.empty()) {
    if (line.rfind(kError, 0) == 0) {
      const std::size_t text = line.find_first_not_of(' ', kError.size());
      first_error_ = text == std::string::npos ? line : line.substr(text);
      error_open_ = true;
    } else if (line.find("Assertion `") != std::string::npos) {
      first_error_ = line;
    }
  }
  lines_.push_back(std::move(line));
  if (lines_.size() > kKeptLines) lines_.pop_front();
}

std::string SumoOutput::tail() const {
  std::string joined;
  const std::size_t first = lines_.size() > 5 ? lines_.size() - 5 : 0;
  for (std::size_t i = first; i < lines_.size(); ++i)
    joined += (joined.empty() ? "" : " | ") + lines_[i];
  if (!partial_.empty()) joined += (joined.empty() ? "" : " | ") + partial_;
  return joined;
}

bool SumoOutput::contains(std::string_view text) const {
  if (partial_.find(text) != std::string::npos) return true;
  for (const std::string& line : lines_)
    if (line.find(text) != std::string::npos) return true;
  return false;
}

SumoProcess::SumoProcess(const std::string& binary, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), binary);
  std::vector<std::string> environment = child_environment();
  const std::vector<char*> argv = pointers(words);
  const std::vector<char*> envp = pointers(environment);

  int output[2], error_pipe[2];
  if (pipe2(output, O_CLOEXEC) != 0)
    throw SumoError(binary, "can't be started: " + std::generic_category().message(errno));
  if (pipe2(error_pipe, O_CLOEXEC) != 0) {
    const int reason = errno;
    close(output[0]);
    close(output[1]);
    throw SumoError(binary, "can't be started: " + std::generic_category().message(reason));
  }
  // fork, not posix_spawn: only so can the child ask to die with us and mark our files
  // close-on-exec
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become_child(argv.data(), envp.data(), output[1], error_pipe[1], parent);
  int reason = pid_ < 0 ? errno : 0;
  close(output[1]);
  close(error_pipe[1]);
  output_fd_ = output[0];
  fcntl(output_fd_, F_SETFL, O_NONBLOCK);
  if (pid_ > 0) {
    ssize_t got = 0;
    do got = read(error_pipe[0], &reason, sizeof reason);
    while (got < 0 && errno == EINTR);
    if (got != sizeof reason) reason = 0;  // closed by a successful exec
  }
  close(error_pipe[0]);
  if (reason != 0) {
    if (pid_ > 0) waitpid(pid_, nullptr, 0);
    close(output_fd_);
    throw Error(binary, "can't be started: " + std::generic_category().message(reason));
  }
}

SumoProcess::~SumoProcess() {
  terminate(0);
  if (output_fd_ >= 0) close(output_fd_);
}

bool SumoProcess::running() {
  if (wait_status_) return false;
  int status = 0;
  const pid_t ended = waitpid(pid_, &status, WNOHANG);
  if (ended == pid_) wait_status_ = status;
  if (ended < 0 && errno == ECHILD) wait_status_ = 0;  // somebody else reaped it
  return !wait_status_;
}

double SumoProcess::cpu_seconds() const {
  clockid_t clock{};
  timespec used{};
  if (wait_status_ || clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &used) != 0)
    return 0.0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

void SumoProcess::drain() {
  char buffer[4096];
  while (output_fd_ >= 0) {
    const ssize_t got = read(output_fd_, buffer, sizeof buffer);
    if (got > 0) {
      output_.append({buffer, static_cast<std::size_t>(got)});
    } else if (got < 0 && errno == EINTR) {
      continue;
    } else if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      return;
    } else {
      output_.append("\n");
      close(output_fd_);
      output_fd_ = -1;
    }
  }
}

bool SumoProcess::wait(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (running()) {
    const auto left = std::chrono::duration<double>(end - Clock::now()).count();
    if (left <= 0) break;
    pollfd wait_for{output_fd_, POLLIN, 0};
    poll(&wait_for, 1, static_cast<int>(std::min(left * 1000 + 1, 20.0)));
    drain();
  }
  drain();
  return !running();
}

void SumoProcess::terminate(double grace) {
  if (!running()) return;
  if (grace > 0) {
    kill(pid_, SIGTERM);
    if (wait(grace)) return;
  }
  kill(pid_, SIGKILL);
  int status = 0;
  pid_t ended = 0;
  do ended = waitpid(pid_, &status, 0);
  while (ended < 0 && errno == EINTR);
  wait_status_ = ended == pid_ ? status : 0;
  drain();
}

std::optional<int> SumoProcess::exit_code() const {
  if (!wait_status_ || !WIFEXITED(*wait_status_)) return std::nullopt;
  return WEXITSTATUS(*wait_status_);
}

std::string SumoProcess::end_description() const {
  if (!wait_status_) return "still running";
  if (WIFSIGNALED(*wait_status_)) {
    const int number = WTERMSIG(*wait_status_);
    const char* name = sigdescr_np(number);
    return "killed by signal " + std::to_string(number) + " (" + (name != nullptr ? name : "?") +
           ")";
  }
  return "exit code " + std::to_string(WEXITSTATUS(*wait_status_));
}

}  // namespace sumogamma
