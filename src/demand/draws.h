#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/random.h"

namespace sumogamma {

/// The demand's own stream of draws: the n-th draw is a pure function of seed and n.
class DemandDraws {
 public:
  DemandDraws(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}
  double uniform() { return random_uniform(seed_, stream_, counter_++, Draw::Demand); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  std::size_t index(std::size_t count) {
    return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
  }
  /// Index drawn by weight; cumulative must be increasing with a positive end.
  std::size_t weighted(const std::vector<double>& cumulative) {
    const double at = uniform() * cumulative.back();
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), at);
    return std::min(static_cast<std::size_t>(found - cumulative.begin()), cumulative.size() - 1);
  }

 private:
  std::uint64_t seed_, stream_, counter_ = 0;
};

}  // namespace sumogamma
