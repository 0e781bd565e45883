#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "base/hash.h"

namespace sumogamma::test {

inline constexpr const char* kOtherLibrary =
    "the recorded bits are those of Debian 12's C library with fused multiply-add";

/// Does the C library compute as where the hashes of exact bits were recorded: Debian 12's, on a
/// processor with fused multiply-add? On one without, or another library, last bits of sines and
/// the like differ, and after some seconds all others do.
inline bool computes_as_recorded() {
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
  return hash == 4397087597476203744ULL;
}

}  // namespace sumogamma::test
