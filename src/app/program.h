#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/run_session.h"

namespace sumogamma {

/// The words of a command line make no command.
class UsageError : public std::runtime_error {
 public:
  explicit UsageError(const std::string& what)
      : std::runtime_error(what + "; see sumo-gamma --help") {}
};

/// Runs the program with the words of its command line, without its own name: {"run", "city", "-o",
/// "out"}. Results for people go to `out`, progress to stderr. Returns the exit code; throws
/// UsageError, Error for what the outside did wrong and SumoError where SUMO failed.
int run_program(const std::vector<std::string>& words, std::FILE* out = stdout);

/// What `sumo-gamma run` is asked for.
struct RunRequest {
  RunOptions run;
  CommonOptions common;
};

/// SCENARIO and options as behind `sumo-gamma run`, but that -o may be missing. Throws UsageError.
RunRequest parse_run(const std::vector<std::string>& words);

/// A number of hundreds of digits, which somebody typed, tells no more than its beginning.
std::string without_long_numbers(const std::string& text);

/// What interrupted() says from now on; may be called by a signal handler.
void set_interrupted(bool now);

}  // namespace sumogamma
