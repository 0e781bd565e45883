#include "ego/paired_tests.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.h"
#include "ego/episode.h"

namespace sumogamma {

namespace {

constexpr std::size_t kResamples = 10000;

double normal_share(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// The inverse of that, by bisection: as exact as erfc, and called a few times.
double normal_quantile(double share) {
  double low = -9.0, high = 9.0;
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (normal_share(middle) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Means of resamples with replacement, in rising order.
std::vector<double> resampled_means(std::span<const double> values, std::uint64_t key) {
  std::vector<double> means(kResamples);
  for (std::size_t sample = 0; sample < kResamples; ++sample) {
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k)
      sum += values[random_bits(key, sample, k, Draw::Demand) % values.size()];
    means[sample] = sum / static_cast<double>(values.size());
  }
  std::sort(means.begin(), means.end());
  return means;
}

/// Of the means that leave one value out.
double skewness_of_jackknife(std::span<const double> values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const double all = mean_of(values);
  double squares = 0, cubes = 0;
  for (const double value : values) {
    const double off = all - (sum - value) / static_cast<double>(values.size() - 1);
    squares += off * off;
    cubes += off * off * off;
  }
  return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

double quantile_of(const std::vector<double>& sorted, double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(place))];
}

}  // namespace

double mcnemar_mid_p(const PairedCounts& counts) {
  const std::size_t n = counts.first + counts.second;
  if (n == 0) return 1.0;
  const std::size_t least = std::min(counts.first, counts.second);
  const auto log_share = [n](std::size_t k) {
    const double all = static_cast<double>(n), some = static_cast<double>(k);
    return std::lgamma(all + 1.0) - std::lgamma(some + 1.0) - std::lgamma(all - some + 1.0) -
           all * std::log(2.0);
  };
  double tail = 0;
  for (std::size_t k = 0; k <= least; ++k) tail += std::exp(log_share(k));
  return std::min(1.0, 2.0 * tail - std::exp(log_share(least)));
}

IntervalEstimate paired_difference(const PairedCounts& counts) {
  const std::size_t n = counts.both + counts.first + counts.second + counts.neither;
  if (n == 0) return {0.0, -1.0, 1.0};
  const double all = static_cast<double>(n);
  const std::size_t yes_first = counts.both + counts.first,
                    yes_second = counts.both + counts.second;
  const double p = static_cast<double>(yes_first) / all, q = static_cast<double>(yes_second) / all;
  const ShareInterval one = wilson_interval(yes_first, n), two = wilson_interval(yes_second, n);
  const double sides = static_cast<double>(yes_first) * static_cast<double>(n - yes_first) *
                       static_cast<double>(yes_second) * static_cast<double>(n - yes_second);
  double cross = static_cast<double>(counts.both) * static_cast<double>(counts.neither) -
                 static_cast<double>(counts.first) * static_cast<double>(counts.second);
  if (cross > 0.0) cross = std::max(cross - 0.5 * all, 0.0);
  const double phi = sides > 0.0 ? cross / std::sqrt(sides) : 0.0;
  const auto side = [&](double a, double b) {
    return std::sqrt(std::max(a * a - 2.0 * phi * a * b + b * b, 0.0));
  };
  return {p - q, p - q - side(p - one.low, two.high - q), p - q + side(one.high - p, q - two.low)};
}

IntervalEstimate bootstrap_mean(std::span<const double> values, std::uint64_t key) {
  const double mean = mean_of(values);
  if (values.size() < 2) return {mean, mean, mean};
  const std::vector<double> means = resampled_means(values, key);
  const auto below = std::lower_bound(means.begin(), means.end(), mean) - means.begin();
  const auto up_to = std::upper_bound(means.begin(), means.end(), mean) - means.begin();
  const double share = 0.5 * static_cast<double>(below + up_to) / static_cast<double>(kResamples);
  const double bias = normal_quantile(std::clamp(share, 1e-6, 1.0 - 1e-6));
  const double skewness = skewness_of_jackknife(values);
  const auto end = [&](double z) {
    return quantile_of(means, normal_share(bias + (bias + z) / (1.0 - skewness * (bias + z))));
  };
  constexpr double z = 1.959963984540054;
  return {mean, end(-z), end(z)};
}

double bootstrap_p(std::span<const double> values, std::uint64_t key) {
  if (values.size() < 2) return 1.0;
  const std::vector<double> means = resampled_means(values, key);
  const auto not_above =
      static_cast<double>(std::upper_bound(means.begin(), means.end(), 0.0) - means.begin());
  const auto not_below =
      static_cast<double>(means.end() - std::lower_bound(means.begin(), means.end(), 0.0));
  const double total = static_cast<double>(kResamples) + 1.0;
  return std::min(1.0, 2.0 * (std::min(not_above, not_below) + 1.0) / total);
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double most = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    most = std::max(most, std::min(1.0, static_cast<double>(order.size() - k) * p[order[k]]));
    adjusted[order[k]] = most;
  }
  return adjusted;
}

}  // namespace sumogamma
