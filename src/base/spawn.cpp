#include "base/spawn.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "base/error.h"

namespace sumogamma {

namespace {

void close_end(int& end) {
  if (end >= 0) close(end);
  end = -1;
}

/// The spawn call's attributes, freed in every case.
struct Attributes {
  posix_spawnattr_t value{};
  Attributes() {
    posix_spawnattr_init(&value);
    sigset_t defaults, none;
    sigemptyset(&defaults);
    for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD}) sigaddset(&defaults, number);
    sigemptyset(&none);
    posix_spawnattr_setpgroup(&value, 0);
    posix_spawnattr_setsigdefault(&value, &defaults);
    posix_spawnattr_setsigmask(&value, &none);
    posix_spawnattr_setflags(
        &value, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~Attributes() { posix_spawnattr_destroy(&value); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
};

std::vector<std::string> merged_environment(
    const std::vector<std::pair<std::string, std::string>>& ours) {
  std::vector<std::string> merged;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    bool replaced = false;
    for (const auto& [key, value] : ours)
      replaced = replaced || (text.size() > key.size() && text.substr(0, key.size()) == key &&
                              text[key.size()] == '=');
    if (!replaced) merged.emplace_back(text);
  }
  for (const auto& [key, value] : ours) merged.push_back(key + "=" + value);
  return merged;
}

std::vector<char*> c_strings(std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  pointers.reserve(strings.size() + 1);
  for (std::string& text : strings) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

Pipe::Pipe() {
  constexpr int kAbove = 10;
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error("pipe", std::strerror(errno));
  read_end = fcntl(ends[0], F_DUPFD_CLOEXEC, kAbove);
  write_end = fcntl(ends[1], F_DUPFD_CLOEXEC, kAbove);
  const int reason = errno;
  for (int& end : ends) close_end(end);
  if (read_end >= 0 && write_end >= 0) return;
  close_read();
  close_write();
  throw Error("pipe", std::strerror(reason));
}

Pipe::~Pipe() {
  close_read();
  close_write();
}

void Pipe::close_read() { close_end(read_end); }
void Pipe::close_write() { close_end(write_end); }

Spawn::Spawn() {
  posix_spawn_file_actions_init(&actions_);
  posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
}

Spawn::~Spawn() { posix_spawn_file_actions_destroy(&actions_); }

void Spawn::give(int descriptor, int number) {
  posix_spawn_file_actions_adddup2(&actions_, descriptor, number);
}

void Spawn::log_into(const std::filesystem::path& file) {
  posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, file.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0644);
  give(STDOUT_FILENO, STDERR_FILENO);
}

void Spawn::run_in(const std::filesystem::path& folder) {
  posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
}

pid_t Spawn::start(std::vector<std::string> arguments,
                   const std::vector<std::pair<std::string, std::string>>& environment) const {
  const Attributes attributes;
  std::vector<std::string> merged = merged_environment(environment);
  const std::vector<char*> argv = c_strings(arguments), envp = c_strings(merged);
  pid_t pid = -1;
  const int failure =
      posix_spawnp(&pid, argv[0], &actions_, &attributes.value, argv.data(), envp.data());
  if (failure != 0)
    throw Error(arguments[0], std::string("cannot be started: ") + std::strerror(failure));
  return pid;
}

}  // namespace sumogamma
