#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace sumogamma {

/// How a command of the program ended, and what it printed.
struct CommandResult {
  int exit_code = 0;   ///< 0 done, 1 a guarantee didn't hold, 130 interrupted
  std::string output;  ///< for people: its standard output
};

/// Runs a command of the program in this process: {"import", "city.osm.pbf", "-o", "city"}. One at
/// a time. Throws Error where the program would exit with 2 and SumoError where with 3.
[[gnu::visibility("default")]] CommandResult run_command(const std::vector<std::string>& words);

/// Ends a command that runs as Ctrl-C would: its outputs are completed. May be called by a signal
/// handler or another thread.
[[gnu::visibility("default")]] void interrupt_command();

/// "0.1.0"
[[gnu::visibility("default")]] std::string version();

}  // namespace sumogamma
