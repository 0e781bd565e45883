#pragma once

#include <CLI/CLI.hpp>
#include <limits>

namespace sumogamma {

/// A finite number from `least` to `most`.
CLI::Validator finite_number(double least = -std::numeric_limits<double>::max(),
                             double most = std::numeric_limits<double>::max());
/// Digits alone, from `least` to `most`: a number type would take -1 for 18446744073709551615.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most);
/// A time of more than 0 s: seconds, h:m:s or d:h:m:s; becomes seconds.
CLI::Validator time_span();

}  // namespace sumogamma
