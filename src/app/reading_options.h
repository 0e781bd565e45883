#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "prediction/recording_formats.h"

namespace sumogamma {

/// What a user tells about recordings on the command line.
struct ReadingArguments {
  std::string format;
  double period = 0, rate = 0, fill = 1.0;
  std::vector<std::string> types;
};

/// Adds --format, --period, --fps, --fill and --type.
void add_reading_options(CLI::App& command, ReadingArguments& arguments);

/// The same for the reader. Throws Error on what contradicts itself.
ReadOptions read_options(const ReadingArguments& arguments);

}  // namespace sumogamma
