#include "demand/count_fit.h"

#include <algorithm>
#include <cmath>

#include "demand/trip_weights.h"

namespace sumogamma {

namespace {

bool leads_over(const RoutedTrip& trip, const EdgeCount& count) {
  const auto& edges = trip.edges;
  for (auto at = edges.begin(); (at = std::find(at, edges.end(), count.edge)) != edges.end(); ++at)
    if (count.to.empty() || (at + 1 != edges.end() && *(at + 1) == count.to)) return true;
  return false;
}

/// A trip with how often it is driven.
struct Driven {
  double per_hour = 0;
  bool fixed = false;
};

double flow_of(const std::vector<std::size_t>& over, const std::vector<Driven>& driven) {
  double flow = 0;
  for (const std::size_t trip : over) flow += driven[trip].per_hour;
  return flow;
}

/// So that the flow is what was counted, by those whose number isn't fixed.
void scale(const std::vector<std::size_t>& over, double counted, std::vector<Driven>& driven) {
  double free = 0, fixed = 0;
  for (const std::size_t trip : over) (driven[trip].fixed ? fixed : free) += driven[trip].per_hour;
  if (free <= 0) return;
  const double factor = std::max(counted - fixed, 0.0) / free;
  for (const std::size_t trip : over)
    if (!driven[trip].fixed) driven[trip].per_hour *= factor;
}

}  // namespace

double geh(double modelled, double counted) {
  const double sum = modelled + counted;
  return sum > 0 ? std::sqrt(2 * (modelled - counted) * (modelled - counted) / sum) : 0;
}

std::vector<CountFit> fit_counts(const std::vector<EdgeCount>& counts,
                                 std::vector<TripPool*>& vehicles) {
  constexpr int kRounds = 500;  // of counts that agree, far fewer do
  std::vector<Driven> driven;
  std::vector<std::vector<std::size_t>> over(counts.size());
  for (const TripPool* pool : vehicles) {
    const double departures = 3600 * pool->agents / mean_duration(*pool);
    const double weights = total_weight(*pool);
    for (const RoutedTrip& trip : pool->trips) {
      for (std::size_t i = 0; i < counts.size(); ++i)
        if (leads_over(trip, counts[i])) over[i].push_back(driven.size());
      driven.push_back({departures * trip.weight / weights, pool->fixed});
    }
  }
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 0; i < counts.size(); ++i) scale(over[i], counts[i].per_hour, driven);

  auto trip = driven.cbegin();
  for (TripPool* pool : vehicles) {
    double agents = 0;
    for (RoutedTrip& one : pool->trips) {
      one.weight = trip++->per_hour;
      agents += one.weight / 3600 * one.duration * pool->slowness;
    }
    pool->agents = agents;
  }
  std::vector<CountFit> fits;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double flow = flow_of(over[i], driven);
    fits.push_back({counts[i], flow, geh(flow, counts[i].per_hour)});
  }
  return fits;
}

}  // namespace sumogamma
