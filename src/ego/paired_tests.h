#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sumogamma {

/// A figure with its 95 % interval.
struct IntervalEstimate {
  double value = 0, low = 0, high = 0;
};

/// Two answers, yes or no, to the same n questions.
struct PairedCounts {
  std::size_t both = 0, first = 0, second = 0, neither = 0;  ///< yes of both, of one alone, of none
};

/// McNemar's exact test of paired shares, mid-p, two-sided; 1 where nobody differs.
double mcnemar_mid_p(const PairedCounts& counts);

/// The first share less the second, with Newcombe's interval for paired shares (Newcombe 1998,
/// Statistics in Medicine 17, 2635-2650, method 10); all of [-1, 1] for no pairs.
IntervalEstimate paired_difference(const PairedCounts& counts);

/// The mean of some values, with the bias-corrected and accelerated bootstrap's interval (Efron
/// 1987) of 10,000 resamples drawn from `key`. One value has no interval but itself. Precondition:
/// not empty.
IntervalEstimate bootstrap_mean(std::span<const double> values, std::uint64_t key);

/// Two-sided bootstrap p of a mean that is not 0, from as many resamples; 1 for one value.
double bootstrap_p(std::span<const double> values, std::uint64_t key);

/// Holm's adjustment of several p, in their order (Holm 1979).
std::vector<double> holm(std::span<const double> p);

}  // namespace sumogamma
