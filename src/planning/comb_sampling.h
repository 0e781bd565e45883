#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sumogamma {

/// Draws entries of `weights` (not negative, their sum positive) by systematic resampling: a comb
/// of `chosen.size()` teeth at equal distances, moved by `draw` in [0, 1) of one, laid over the
/// cumulative weights. Each entry is chosen as often as its share says, give or take one; `chosen`
/// ascends.
inline void comb_sample(std::span<const double> weights, double draw,
                        std::span<std::uint32_t> chosen) {
  double total = 0;
  std::uint32_t last = 0;  // with a weight: takes the teeth that rounding leaves beyond all
  for (std::uint32_t i = 0; i < weights.size(); ++i) {
    total += weights[i];
    if (weights[i] > 0) last = i;
  }
  const double distance = total / static_cast<double>(chosen.size());
  std::uint32_t entry = 0;
  double up_to = weights[0];
  for (std::size_t tooth = 0; tooth < chosen.size(); ++tooth) {
    const double place = (static_cast<double>(tooth) + draw) * distance;
    while (entry < last && place >= up_to) up_to += weights[++entry];
    chosen[tooth] = entry;
  }
}

}  // namespace sumogamma
