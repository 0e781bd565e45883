#include "study/distribution_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.h"

namespace sumogamma {

std::size_t Bins::index(double value) const {
  const double place = (value - low) / width();
  // a comparison that is false for NaN sends it to the first bin
  if (!(place > 0.0)) return 0;
  return place < static_cast<double>(count) ? static_cast<std::size_t>(place) : count - 1;
}

DistributionDistance distance_of(std::span<const double> a, std::span<const double> b,
                                 double bin_width) {
  const double all_a = std::accumulate(a.begin(), a.end(), 0.0);
  const double all_b = std::accumulate(b.begin(), b.end(), 0.0);
  DistributionDistance distance;
  double overlap = 0, ahead = 0;
  const auto divergence = [](double p, double m) { return p > 0.0 ? p * std::log2(p / m) : 0.0; };
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double p = a[k] / all_a, q = b[k] / all_b, m = 0.5 * (p + q);
    overlap += std::sqrt(p * q);
    distance.jensen_shannon += 0.5 * (divergence(p, m) + divergence(q, m));
    ahead += p - q;
    distance.wasserstein += std::abs(ahead) * bin_width;
    distance.kolmogorov_smirnov = std::max(distance.kolmogorov_smirnov, std::abs(ahead));
  }
  distance.hellinger = std::sqrt(std::max(0.0, 1.0 - overlap));
  return distance;
}

std::vector<double> sum_of(std::span<const AgentHistogram> agents, std::size_t bins) {
  std::vector<double> sum(bins, 0.0);
  for (const AgentHistogram& agent : agents)
    for (std::size_t k = 0; k < bins; ++k) sum[k] += static_cast<double>(agent.counts[k]);
  return sum;
}

namespace {

/// Draws that follow one another.
class Stream {
 public:
  Stream(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}
  std::size_t below(std::size_t count) {
    const double draw = random_uniform(seed_, stream_, next_++, Draw::Bootstrap);
    return std::min(static_cast<std::size_t>(draw * static_cast<double>(count)), count - 1);
  }

 private:
  std::uint64_t seed_, stream_, next_ = 0;
};

using Groups = std::vector<std::vector<const AgentHistogram*>>;

Groups groups_of(std::span<const AgentHistogram> agents) {
  Groups groups;
  for (const AgentHistogram& agent : agents) {
    if (groups.size() <= agent.group) groups.resize(agent.group + 1);
    groups[agent.group].push_back(&agent);
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

std::vector<double> resampled(const Groups& groups, std::size_t bins, Stream& stream) {
  std::vector<double> sum(bins, 0.0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto& group = groups.size() > 1 ? groups[stream.below(groups.size())] : groups.front();
    for (std::size_t i = 0; i < group.size(); ++i) {
      const AgentHistogram& agent = *group[stream.below(group.size())];
      for (std::size_t k = 0; k < bins; ++k) sum[k] += static_cast<double>(agent.counts[k]);
    }
  }
  return sum;
}

/// The distance of two random parts of all agents, as large as the two sides.
DistributionDistance by_chance(std::vector<const AgentHistogram*>& all, std::size_t first,
                               const Bins& bins, Stream& stream) {
  std::vector<double> one(bins.count, 0.0), other(bins.count, 0.0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i < first) std::swap(all[i], all[i + stream.below(all.size() - i)]);
    std::vector<double>& sum = i < first ? one : other;
    for (std::size_t k = 0; k < bins.count; ++k) sum[k] += static_cast<double>(all[i]->counts[k]);
  }
  return distance_of(one, other, bins.width());
}

constexpr double DistributionDistance::*kFigures[] = {
    &DistributionDistance::hellinger, &DistributionDistance::jensen_shannon,
    &DistributionDistance::wasserstein, &DistributionDistance::kolmogorov_smirnov};

/// The value that this share of the samples doesn't exceed, figure by figure.
DistributionDistance percentile(const std::vector<DistributionDistance>& samples, double share) {
  DistributionDistance result;
  std::vector<double> values(samples.size());
  for (const auto figure : kFigures) {
    std::transform(samples.begin(), samples.end(), values.begin(),
                   [&](const DistributionDistance& one) { return one.*figure; });
    std::sort(values.begin(), values.end());
    result.*figure =
        values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  }
  return result;
}

}  // namespace

DistanceEstimate estimate_distance(std::span<const AgentHistogram> a,
                                   std::span<const AgentHistogram> b, const Bins& bins,
                                   std::size_t samples, std::uint64_t seed) {
  DistanceEstimate estimate;
  if (a.empty() || b.empty()) return estimate;
  estimate.known = true;
  estimate.value = distance_of(sum_of(a, bins.count), sum_of(b, bins.count), bins.width());
  const Groups of_a = groups_of(a), of_b = groups_of(b);
  std::vector<const AgentHistogram*> all;
  for (const AgentHistogram& agent : a) all.push_back(&agent);
  for (const AgentHistogram& agent : b) all.push_back(&agent);
  std::vector<DistributionDistance> drawn, chance;
  for (std::size_t sample = 0; sample < samples; ++sample) {
    Stream stream(seed, sample);
    const std::vector<double> one = resampled(of_a, bins.count, stream);
    drawn.push_back(distance_of(one, resampled(of_b, bins.count, stream), bins.width()));
    chance.push_back(by_chance(all, a.size(), bins, stream));
  }
  if (samples == 0) return estimate;
  estimate.low = percentile(drawn, 0.025);
  estimate.high = percentile(drawn, 0.975);
  estimate.chance = percentile(chance, 0.95);
  return estimate;
}

}  // namespace sumogamma
