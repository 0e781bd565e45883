#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sumogamma {

/// Counts of non-negative values in bins of equal width, for quantiles of a run of any length in
/// constant memory. Values beyond the last bin count there, and their maximum is kept.
class Histogram {
 public:
  Histogram(double bin_width, std::size_t bins) : bin_width_(bin_width), counts_(bins, 0) {}

  /// Negative values count as zero; values that aren't finite are ignored.
  void add(double value) {
    if (!std::isfinite(value)) return;
    const double bin = std::max(value, 0.0) / bin_width_;
    const std::size_t last = counts_.size() - 1;
    ++counts_[bin < static_cast<double>(last) ? static_cast<std::size_t>(bin) : last];
    ++total_;
    maximum_ = std::max(maximum_, value);
  }

  std::uint64_t total() const { return total_; }
  double maximum() const { return maximum_; }

  /// Least x with a share of at least `share` of the values at or below it, interpolated within its
  /// bin and never above the maximum: exact to one bin width. 0 without values.
  double quantile(double share) const {
    if (total_ == 0) return 0.0;
    const double wanted = share * static_cast<double>(total_);
    double below = 0;
    for (std::size_t bin = 0; bin + 1 < counts_.size(); ++bin) {
      const double count = static_cast<double>(counts_[bin]);
      if (count > 0 && below + count >= wanted)
        return std::min((static_cast<double>(bin) + (wanted - below) / count) * bin_width_,
                        maximum_);
      below += count;
    }
    return maximum_;
  }

 private:
  double bin_width_;
  std::vector<std::uint64_t> counts_;
  std::uint64_t total_ = 0;
  double maximum_ = 0;
};

}  // namespace sumogamma
