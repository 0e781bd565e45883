#include "base/time_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace sumogamma {
namespace {

std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> parse_time(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\n\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return std::nullopt;
  text = text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
  const bool negative = text.front() == '-';
  if (negative) text.remove_prefix(1);
  std::array<double, 4> part{};
  std::size_t count = 0;
  for (std::size_t begin = 0; begin <= text.size(); ++count) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    const std::optional<double> value = parse_number(text.substr(begin, end - begin));
    if (!value || *value < 0 || count == part.size()) return std::nullopt;
    part[count] = *value;
    begin = end + 1;
  }
  double seconds = part[0];
  if (count == 2) return std::nullopt;
  if (count == 3) seconds = part[0] * 3600 + part[1] * 60 + part[2];
  if (count == 4) seconds = part[0] * 86400 + part[1] * 3600 + part[2] * 60 + part[3];
  return negative ? -seconds : seconds;
}

}  // namespace sumogamma
