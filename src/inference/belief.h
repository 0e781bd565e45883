#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "inference/hypotheses.h"

namespace sumogamma {

/// Histogram over N hypotheses of one factor, kept as logarithms: it never underflows.
template <std::size_t N>
struct HypothesisWeights {
  std::array<double, N> log_weight{};

  /// Normalised to sum 1. Weights of zero in the prior stay zero.
  static HypothesisWeights from(const std::array<double, N>& prior) {
    HypothesisWeights histogram;
    for (std::size_t k = 0; k < N; ++k)
      histogram.log_weight[k] = prior[k] > 0 ? std::log(prior[k]) : -1e300;
    histogram.normalize();
    return histogram;
  }

  std::array<double, N> weights() const {
    std::array<double, N> w{};
    for (std::size_t k = 0; k < N; ++k)
      if (!ruled_out(k)) w[k] = std::exp(log_weight[k]);
    return w;
  }

  /// A hypothesis that the prior left nothing.
  bool ruled_out(std::size_t k) const { return log_weight[k] <= -1e299; }

  /// Index of the largest weight, the first of equals.
  std::size_t most_likely() const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < N; ++k)
      if (log_weight[k] > log_weight[best]) best = k;
    return best;
  }

  /// Bayes (Eq. 10): adds log likelihoods and normalises. Likelihoods that are all minus infinity,
  /// or not numbers, tell nothing and leave the belief as it was.
  void update(const std::array<double, N>& log_likelihood) {
    const HypothesisWeights before = *this;
    for (std::size_t k = 0; k < N; ++k) log_weight[k] += log_likelihood[k];
    if (!normalize()) *this = before;
  }

  /// A change of mind: with this probability the next state is drawn from the prior again.
  void forget(double probability, const std::array<double, N>& prior) {
    if (probability <= 0) return;
    const std::array<double, N> now = weights();
    double total = 0;
    for (const double p : prior) total += p;
    std::array<double, N> next{};
    for (std::size_t k = 0; k < N; ++k)
      next[k] = (1.0 - probability) * now[k] + probability * prior[k] / total;
    *this = from(next);
  }

 private:
  bool normalize() {
    double most = log_weight[0];
    for (const double w : log_weight) most = w > most ? w : most;
    double sum = 0;
    for (std::size_t k = 0; k < N; ++k)
      if (!ruled_out(k)) sum += std::exp(log_weight[k] - most);
    if (!std::isfinite(sum) || !std::isfinite(most) || most <= -1e299) return false;
    const double scale = most + std::log(sum);
    for (std::size_t k = 0; k < N; ++k)
      log_weight[k] = ruled_out(k) ? -1e300 : log_weight[k] - scale;
    return true;
  }
};

/// p(theta) of III-E, factored: intention, attention range and responsibility are independent given
/// the track. A joint histogram would cost the product of their sizes in passes of the model.
struct Belief {
  HypothesisWeights<kIntentions> intention;
  HypothesisWeights<kAttentions> attention;
  HypothesisWeights<kResponsibilities> responsibility;
};

/// Log of Eq. 9's density of an observation at `distance` [m] from the expected place, two
/// dimensions, up to a constant. The tail is flattened: one outlier rules out nothing.
inline double log_likelihood(double distance, double deviation) {
  constexpr double kOutlier = 1e-3;
  const double x = distance / deviation;
  return std::log(std::exp(-0.5 * x * x) + kOutlier);
}

}  // namespace sumogamma
