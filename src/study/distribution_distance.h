#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sumogamma {

/// Bins of equal width; values beyond an end count in the bin there.
struct Bins {
  double low = 0, high = 1;
  std::size_t count = 1;

  double width() const { return (high - low) / static_cast<double>(count); }
  std::size_t index(double value) const;
};

/// How far two distributions over the same bins are from each other. All are 0 for equal ones and
/// symmetric.
struct DistributionDistance {
  double hellinger = 0;           ///< sqrt(1 - sum sqrt(p q)), 0 to 1
  double jensen_shannon = 0;      ///< divergence in bits, 0 to 1 (Lin 1991)
  double wasserstein = 0;         ///< of order 1, in the values' unit, to a bin's width
  double kolmogorov_smirnov = 0;  ///< largest difference of shares, at the bins' ends, 0 to 1
};

/// Of two histograms (counts, not all 0) over bins of this width.
DistributionDistance distance_of(std::span<const double> a, std::span<const double> b,
                                 double bin_width);

/// One agent's values of one measure, counted.
struct AgentHistogram {
  std::uint32_t group = 0;  ///< run or recording that it was in
  std::vector<float> counts;
};

/// A distance with a bootstrap interval.
struct DistanceEstimate {
  DistributionDistance value, low, high;  ///< 95 % interval, by percentiles
  DistributionDistance chance;  ///< below this are 95 % of the distances of two random halves of
                                ///< all agents, of these sizes: what is less tells no difference
  bool known = false;           ///< both sides have values
};

/// Resamples groups (seeds, recordings) and, within them, agents, each with all its values: values
/// of one agent aren't independent. With one group on a side agents alone are resampled. The same
/// for the same seed.
DistanceEstimate estimate_distance(std::span<const AgentHistogram> a,
                                   std::span<const AgentHistogram> b, const Bins& bins,
                                   std::size_t samples, std::uint64_t seed);

/// Sum of all agents' counts.
std::vector<double> sum_of(std::span<const AgentHistogram> agents, std::size_t bins);

}  // namespace sumogamma
