#pragma once

#include <fmt/format.h>

#include <string>

namespace sumogamma {

/// A number for a message: "0.05", "1e+300"; never hundreds of digits.
inline std::string number_text(double value) { return fmt::format("{:.10g}", value); }

}  // namespace sumogamma
