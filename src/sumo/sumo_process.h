#pragma once

#include <sys/types.h>

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sumogamma {

/// Path of an executable of SUMO: `name` itself where it holds a slash, else $SUMO_HOME/bin/name,
/// else the first in PATH. Throws Error where there is none.
std::string find_sumo_binary(const std::string& name);

/// Sets SUMO_HOME for this process to where Debian puts it, unless the user has set it; for SUMO in
/// process.
void set_default_sumo_home();

/// A TCP port on 127.0.0.1 that nobody used a moment ago.
int free_port();

/// What SUMO prints, kept within bounds: the first error, the last lines and a count of the
/// warnings.
class SumoOutput {
 public:
  void append(std::string_view text);
  /// First line that tells of an error or a failed assertion, without "Error: "; empty: none so
  /// far. A message that goes on in indented lines is joined.
  const std::string& first_error() const { return first_error_; }
  /// The last few lines, joined.
  std::string tail() const;
  /// Lines of warning so far.
  long warnings() const { return warnings_; }
  /// The first few warnings of a run, without "Warning: ", each handed out once.
  std::vector<std::string> take_first_warnings() { return std::exchange(first_warnings_, {}); }
  bool contains(std::string_view text) const;

 private:
  void add_line(std::string line);

  std::string partial_;
  std::deque<std::string> lines_;
  std::string first_error_;
  bool error_open_ = false;  // the next indented line belongs to first_error_
  long warnings_ = 0;
  std::vector<std::string> first_warnings_;
};

/// A child process in its own process group (so that Ctrl-C in the terminal reaches us alone), its
/// stdout and stderr read through a pipe. It dies with the thread that started it; the destructor
/// kills and reaps it: no orphan, no zombie.
class SumoProcess {
 public:
  /// Starts binary with arguments. SUMO_HOME is set to Debian's place where it is unset. Throws
  /// Error where it can't.
  SumoProcess(const std::string& binary, const std::vector<std::string>& arguments);
  ~SumoProcess();
  SumoProcess(const SumoProcess&) = delete;
  SumoProcess& operator=(const SumoProcess&) = delete;

  pid_t pid() const { return pid_; }
  /// Reaps the child if it has ended.
  bool running();
  /// CPU time that it has used [s]; 0 once it has ended.
  double cpu_seconds() const;
  /// Waits up to `seconds` for the end, reading its output meanwhile; true: ended.
  bool wait(double seconds);
  /// SIGTERM, `grace` seconds of patience, then SIGKILL; reaped on return.
  void terminate(double grace);

  /// Exit code, or empty while it runs or where a signal ended it.
  std::optional<int> exit_code() const;
  /// "exit code 1", "killed by signal 9 (Killed)" or "still running".
  std::string end_description() const;

  /// Readable when there is output; -1 once it is closed.
  int output_fd() const { return output_fd_; }
  /// Reads what is there without waiting.
  void drain();
  const SumoOutput& output() const { return output_; }
  SumoOutput& output() { return output_; }

 private:
  pid_t pid_ = -1;
  int output_fd_ = -1;
  std::optional<int> wait_status_;
  SumoOutput output_;
};

}  // namespace sumogamma
