#pragma once

#include <cstdint>

#include "base/random.h"

namespace sumogamma {

/// The k-th number of a test's seed, uniform in [low, high).
inline double drawn_number(std::uint64_t seed, std::uint64_t k, double low, double high) {
  return random_uniform(seed, k, 0, Draw::ProcessNoise, low, high);
}

}  // namespace sumogamma
