#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace sumogamma {

/// The outside is wrong (a file, an option): one line "<file or id>: what, expected what". Exit
/// code 2.
class [[gnu::visibility("default")]] Error : public std::runtime_error {
 public:
  Error(std::string_view where, std::string_view what);
};

/// SUMO failed or went away while it was needed. Exit code 3; outputs so far are complete.
class [[gnu::visibility("default")]] SumoError : public Error {
 public:
  using Error::Error;
};

}  // namespace sumogamma
