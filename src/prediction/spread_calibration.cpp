#include "prediction/spread_calibration.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {
// bins are even in the logarithm of the error: from 0.01 deviations, by 15 %
constexpr double kFirst = 0.01, kGrowth = 0.14;
constexpr double kCovered = 0.9;
constexpr double kLeastScale = 0.4, kMostScale = 2.5;

/// Share of a normal cloud in the plane within so many deviations.
double normal_share(double deviations) { return -std::expm1(-0.5 * deviations * deviations); }
}  // namespace

std::size_t SpreadCalibration::bin_of(double deviations) {
  const double bin = std::log(std::max(deviations, kFirst) / kFirst) / kGrowth;
  return std::min(static_cast<std::size_t>(bin), kBins - 1);
}

double SpreadCalibration::quantile_scale(const Bins& errors, double total) {
  const double wanted = kCovered * (total + kPrior);
  double sum = 0, below = 0;
  for (std::size_t k = 0; k < kBins; ++k) {
    const double upper = kFirst * std::exp(kGrowth * static_cast<double>(k + 1));
    const double before = sum + kPrior * below;
    sum += errors[k];
    below = normal_share(upper);
    const double after = sum + kPrior * below;
    if (after < wanted || after <= before) continue;
    const double share = (wanted - before) / (after - before);
    const double quantile = upper * std::exp(kGrowth * (share - 1.0));
    const double assumed = std::sqrt(-2.0 * std::log1p(-kCovered));
    return std::clamp(quantile / assumed, kLeastScale, kMostScale);
  }
  return kMostScale;
}

void SpreadCalibration::remember(std::uint32_t agent, std::size_t kind,
                                 std::span<const Vec2> predicted, const Spread& spread) {
  Forecast& forecast = recent_.add(agent, kind);
  for (std::size_t check = 0; check < kChecks; ++check) {
    const std::size_t step = recent_.step_of(check);
    forecast.predicted[check] = predicted[std::min(step, predicted.size() - 1)];
    forecast.along[check] = spread.along[step];
    forecast.across[check] = spread.across[step];
  }
  forecast.forward = spread.forward;
}

void SpreadCalibration::resolve(std::uint32_t agent, const Vec2& position) {
  recent_.for_due(agent, [&](std::size_t kind, std::size_t check, const Forecast& forecast) {
    const Vec2 error = position - forecast.predicted[check];
    const double along = error.dot(forecast.forward) / forecast.along[check];
    const double across = error.dot(left_of(forecast.forward)) / forecast.across[check];
    const double deviations = std::hypot(along, across);
    if (!std::isfinite(deviations)) return;
    errors_[kind][bin_of(deviations)] += 1.0;
    total_[kind] += 1.0;
  });
}

void SpreadCalibration::end_frame() {
  recent_.end_frame();
  for (std::size_t kind = 0; kind < errors_.size(); ++kind) {
    if (total_[kind] > kMost) {
      for (double& count : errors_[kind]) count *= 0.5;
      total_[kind] *= 0.5;
    }
    scale_[kind] = quantile_scale(errors_[kind], total_[kind]);
  }
}

}  // namespace sumogamma
