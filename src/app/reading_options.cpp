#include "app/reading_options.h"

#include "app/validators.h"
#include "base/error.h"

namespace sumogamma {

void add_reading_options(CLI::App& command, ReadingArguments& arguments) {
  command.add_option("--format", arguments.format,
                     "what the recordings must be: " + recording_formats());
  command
      .add_option("--period", arguments.period,
                  "time from one frame of the recordings to the next [s]")
      ->check(finite_number(1e-4, 10.0));
  command.add_option("--fps", arguments.rate, "the same as frames a second")
      ->check(finite_number(0.1, 10000.0));
  command.add_option("--fill", arguments.fill, "gaps up to this long are filled [s]")
      ->check(finite_number(0.0, 60.0))
      ->capture_default_str();
  command.add_option("--type", arguments.types,
                     "THEIRS=OURS: what a type of the recordings is here (may be repeated)");
}

ReadOptions read_options(const ReadingArguments& arguments) {
  ReadOptions read;
  read.format = arguments.format;
  read.fill = arguments.fill;
  if (arguments.period > 0 && arguments.rate > 0)
    throw Error("--fps", "stands beside --period, expected one of them");
  read.period = arguments.rate > 0 ? 1.0 / arguments.rate : arguments.period;
  for (const std::string& pair : arguments.types) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error("--type " + pair, "expected THEIRS=OURS, such as lorry=truck");
    read.types[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  return read;
}

}  // namespace sumogamma
