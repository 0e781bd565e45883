#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace sumogamma {

/// A program to run to its end.
struct ProcessRequest {
  std::vector<std::string> arguments;  ///< [0] is the program, looked up in PATH
  std::vector<std::pair<std::string, std::string>> environment;  ///< added to, or replacing, ours
  std::filesystem::path folder;                                  ///< to run in; empty: ours
  /// Both streams go into this file, begun anew, instead of being gathered: it is complete also
  /// where this process is killed, and the program isn't disturbed by that.
  std::filesystem::path log{};
  double time_limit = 600.0;  ///< [s] of wall time, after which it is ended
  std::size_t output_limit =
      1 << 26;  ///< bytes kept of each stream; the rest is read and thrown away
  std::function<bool()> should_stop;  ///< asked about ten times a second; true ends the program
};

/// How it ended. Exactly one of: exited (signal == 0), killed by a signal (signal != 0).
struct ProcessResult {
  int exit_code = 0;       ///< valid where signal == 0
  int signal = 0;          ///< that ended it, else 0
  bool timed_out = false;  ///< we ended it because time was up
  bool stopped = false;    ///< we ended it because should_stop said so
  std::string output;      ///< stdout
  std::string errors;      ///< stderr

  bool ok() const { return signal == 0 && exit_code == 0 && !timed_out && !stopped; }
};

/// Runs the program in a process group of its own with stdin from /dev/null, gathers both streams,
/// and waits. The program never outlives this call: on time-out, stop or exception its group gets
/// SIGTERM and, after two seconds, SIGKILL. Throws Error naming the program where it cannot be
/// started.
ProcessResult run_process(const ProcessRequest& request);

/// Kills whatever runs in run_process() at once, for who is about to end this process without
/// waiting for it.
void kill_running_processes() noexcept;

/// "exit code 3", "killed by signal 11 (Segmentation fault)", "no end after 600 s": for messages.
std::string describe_end(const ProcessResult& result, double time_limit);

/// This program's own file.
std::filesystem::path own_program();

/// Full path of a program in $SUMO_HOME/bin or PATH; empty where there is none.
std::filesystem::path find_program(const std::string& name);

}  // namespace sumogamma
