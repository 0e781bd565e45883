#include "app/validators.h"

#include <charconv>
#include <cmath>
#include <string>

#include "base/number_text.h"
#include "base/time_text.h"

namespace sumogamma {

CLI::Validator finite_number(double least, double most) {
  const bool bounded = most < std::numeric_limits<double>::max();
  const std::string what =
      bounded ? "must be a number from " + number_text(least) + " to " + number_text(most)
      : least > -std::numeric_limits<double>::max()
          ? "must be a finite number of at least " + number_text(least)
          : "must be a finite number";
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool fits = error == std::errc() && end == text.data() + text.size() &&
                          std::isfinite(value) && value >= least && value <= most;
        return fits ? std::string() : what;
      },
      "FLOAT");
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  const std::string what =
      "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  return CLI::Validator(
      [=](std::string& text) {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool fits = error == std::errc() && end == text.data() + text.size() &&
                          value >= least && value <= most;
        return fits ? std::string() : what;
      },
      "UINT");
}

CLI::Validator time_span() {
  return CLI::Validator(
      [](std::string& text) {
        const std::optional<double> seconds = parse_time(text);
        constexpr double kLongest = 1e9;
        if (!seconds || *seconds <= 0.0 || *seconds > kLongest)
          return std::string("must be more than 0 s: seconds, h:m:s or d:h:m:s");
        text = number_text(*seconds);
        return std::string();
      },
      "TIME");
}

}  // namespace sumogamma
