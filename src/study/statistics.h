#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sumogamma {

/// A mean and how sure it is.
struct Estimate {
  std::size_t count = 0;
  double mean = 0;
  double deviation = 0;      ///< of single values, with count - 1; 0 for fewer than two
  double low = 0, high = 0;  ///< of the interval; not numbers where one value doesn't tell
  bool has_interval() const { return low <= high; }
};

/// x with P(T <= x) = `probability` for Student's t with that many degrees of freedom (> 0, need
/// not be whole).
double student_quantile(double degrees, double probability);

/// Mean of independent values with Student's two-sided interval of this confidence. Values that
/// aren't finite are left out. Without values: count 0, the rest 0 and no interval.
Estimate estimate_mean(std::span<const double> values, double confidence = 0.95);

/// The mean of the strata's means, each with the same weight: for fixed scenarios with several
/// seeds each. Its variance is that within the strata; degrees of freedom by Welch and
/// Satterthwaite. `deviation` is the root of the strata's mean variance. Empty strata are left out;
/// one with a single value leaves no interval.
Estimate estimate_over_strata(std::span<const std::vector<double>> strata,
                              double confidence = 0.95);

}  // namespace sumogamma
