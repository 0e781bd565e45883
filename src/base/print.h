#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace sumogamma {

/// Writes formatted text to a stream as far as that takes it: whether stdout took everything is
/// asked once, at the end of main().
template <typename... Values>
void print(std::FILE* stream, fmt::format_string<Values...> pattern, Values&&... values) {
  const std::string text = fmt::format(pattern, std::forward<Values>(values)...);
  std::fwrite(text.data(), 1, text.size(), stream);
}

}  // namespace sumogamma
