#include "base/hash.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

namespace sumogamma {

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::uint64_t hash_of_math_library() {
  double (*const functions[])(double) = {std::sin,  std::cos, std::tan,
                                         std::atan, std::exp, std::log};
  std::uint64_t hash = kFnvBasis;
  for (const auto function : functions)
    for (int k = 1; k < 2000; ++k) {
      const volatile double argument = 0.0035 * k;  // computed here, not by the compiler
      const auto bits = std::bit_cast<std::uint64_t>(function(argument));
      for (int byte = 0; byte < 8; ++byte)
        hash = fnv1a(hash, static_cast<unsigned char>(bits >> (8 * byte)));
    }
  return hash;
}

}  // namespace sumogamma
