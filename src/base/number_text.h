#pragma once

#include <cstdio>
#include <string>

namespace sumogamma {

/// A number for a message: "0.05", "1e+300"; never hundreds of digits.
inline std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

}  // namespace sumogamma
