#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sumogamma {

/// A pipe whose ends close themselves, aren't inherited, and lie above any descriptor that a child
/// is to have.
struct Pipe {
  int read_end = -1, write_end = -1;
  /// Throws Error where there are no more.
  Pipe();
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_read();
  void close_write();
};

/// How a program is started: no shell, stdin from /dev/null, in a process group of its own, so that
/// its children end with it, and with default signals, since ours ignores SIGPIPE.
class Spawn {
 public:
  Spawn();
  ~Spawn();
  Spawn(const Spawn&) = delete;
  Spawn& operator=(const Spawn&) = delete;

  /// The program has one of our descriptors as its own `number`.
  void give(int descriptor, int number);
  /// Both its streams go into this file, begun anew.
  void log_into(const std::filesystem::path& file);
  void run_in(const std::filesystem::path& folder);

  /// Returns its process, whose group has the same number. `arguments`: [0] is the program, looked
  /// up in PATH. `environment`: added to, or replacing, ours. Throws Error naming the program where
  /// it cannot be started.
  pid_t start(std::vector<std::string> arguments,
              const std::vector<std::pair<std::string, std::string>>& environment = {}) const;

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace sumogamma
