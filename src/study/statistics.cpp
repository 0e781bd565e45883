#include "study/statistics.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace sumogamma {

double student_quantile(double degrees, double probability) {
  return boost::math::quantile(boost::math::students_t_distribution<double>(degrees), probability);
}

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

void set_interval(double variance_of_mean, double degrees, double confidence, Estimate& estimate) {
  const double half = variance_of_mean > 0.0 ? student_quantile(degrees, 0.5 + 0.5 * confidence) *
                                                   std::sqrt(variance_of_mean)
                                             : 0.0;
  estimate.low = estimate.mean - half;
  estimate.high = estimate.mean + half;
}

}  // namespace

Estimate estimate_mean(std::span<const double> values, double confidence) {
  Estimate estimate;
  estimate.low = estimate.high = kUnknown;
  double sum = 0;
  for (const double value : values)
    if (std::isfinite(value)) {
      sum += value;
      ++estimate.count;
    }
  if (estimate.count == 0) return estimate;
  const double count = static_cast<double>(estimate.count);
  estimate.mean = sum / count;
  if (estimate.count < 2) return estimate;
  double squares = 0;
  for (const double value : values)
    if (std::isfinite(value)) squares += (value - estimate.mean) * (value - estimate.mean);
  estimate.deviation = std::sqrt(squares / (count - 1.0));
  set_interval(squares / (count - 1.0) / count, count - 1.0, confidence, estimate);
  return estimate;
}

Estimate estimate_over_strata(std::span<const std::vector<double>> strata, double confidence) {
  Estimate whole;
  whole.low = whole.high = kUnknown;
  double means = 0, variances = 0, of_mean = 0, fourth = 0, count = 0;
  bool known = true;
  for (const std::vector<double>& stratum : strata) {
    const Estimate one = estimate_mean(stratum, confidence);
    if (one.count == 0) continue;
    whole.count += one.count;
    ++count;
    means += one.mean;
    if (one.count < 2) {
      known = false;
      continue;
    }
    const double size = static_cast<double>(one.count);
    const double part = one.deviation * one.deviation / size;
    variances += one.deviation * one.deviation;
    of_mean += part;
    fourth += part * part / (size - 1.0);
  }
  if (whole.count == 0) return whole;
  whole.mean = means / count;
  whole.deviation = std::sqrt(variances / count);
  if (known)
    set_interval(of_mean / (count * count), fourth > 0.0 ? of_mean * of_mean / fourth : 1.0,
                 confidence, whole);
  return whole;
}

}  // namespace sumogamma
