#include "base/error.h"

#include <algorithm>

namespace sumogamma {

namespace {

// what is quoted from a file may hold line breaks, or what a terminal obeys
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

}  // namespace

Error::Error(std::string_view where, std::string_view what)
    : std::runtime_error(on_one_line(std::string(where) + ": " + std::string(what))) {}

}  // namespace sumogamma
