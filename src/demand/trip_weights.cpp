#include "demand/trip_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "demand/lane_load.h"

namespace sumogamma {
namespace {

constexpr double kAim = 0.9;      // load of a lane; beyond, waits get long by chance alone
constexpr int kRounds = 60;       // after which weights hardly move any more
constexpr double kRarest = 0.02;  // no trip's weight gets less
constexpr std::size_t kLengthGroups = 5;

/// Shares of who drives a step on each of its ways: drivers prefer the lane that is less full.
std::vector<double> shares_of(const RoadNetwork& road, const std::vector<ConnectionId>& step,
                              const std::vector<double>& load) {
  constexpr double kEmpty = 0.05;
  std::vector<double> shares;
  for (const ConnectionId way : step)
    shares.push_back(1.0 / std::max(kEmpty, load[index_of(road.connection(way).from)]));
  const double total = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= total;
  return shares;
}

/// Vehicles/s, in cars, by connection.
std::vector<double> flows(const RoadNetwork& road, const std::vector<TripPool>& pools,
                          const std::vector<double>& load) {
  std::vector<double> flow(road.connections.size());
  for (const TripPool& pool : pools) {
    const double total = total_weight(pool);
    const double rate = pool.agents * pool.car_units / mean_duration(pool);
    for (const RoutedTrip& trip : pool.trips)
      for (const std::vector<ConnectionId>& step : trip.steps) {
        const std::vector<double> shares = shares_of(road, step, load);
        for (std::size_t i = 0; i < step.size(); ++i)
          flow[index_of(step[i])] += rate * trip.weight / total * shares[i];
      }
  }
  return flow;
}

/// Load of the fullest place on a trip's way.
double worst_load(const RoadNetwork& road, const RoutedTrip& trip,
                  const std::vector<double>& load) {
  double worst = 0;
  for (const std::vector<ConnectionId>& step : trip.steps) {
    const std::vector<double> shares = shares_of(road, step, load);
    double mean = 0;
    for (std::size_t i = 0; i < step.size(); ++i)
      mean += shares[i] * load[index_of(road.connection(step[i]).from)];
    worst = std::max(worst, mean);
  }
  return worst;
}

/// Mean over a pool by weight, with what others cost [s].
double mean_time(const TripPool& pool, double RoutedTrip::*time) {
  double seconds = 0;
  for (const RoutedTrip& trip : pool.trips) seconds += trip.weight * trip.*time * pool.slowness;
  return seconds / total_weight(pool);
}

/// Gives each fifth of the trips, by length, its share again.
void restore_lengths(std::vector<RoutedTrip>& trips) {
  std::vector<std::size_t> by_length(trips.size());
  std::iota(by_length.begin(), by_length.end(), std::size_t{0});
  std::stable_sort(by_length.begin(), by_length.end(),
                   [&](std::size_t a, std::size_t b) { return trips[a].length < trips[b].length; });
  for (std::size_t group = 0; group < kLengthGroups; ++group) {
    const std::size_t first = trips.size() * group / kLengthGroups,
                      end = trips.size() * (group + 1) / kLengthGroups;
    double total = 0;
    for (std::size_t i = first; i < end; ++i) total += trips[by_length[i]].weight;
    for (std::size_t i = first; i < end; ++i)
      trips[by_length[i]].weight *= static_cast<double>(end - first) / total;
  }
}

}  // namespace

double total_weight(const TripPool& pool) {
  double total = 0;
  for (const RoutedTrip& trip : pool.trips) total += trip.weight;
  return total;
}

double mean_length(const TripPool& pool) {
  const double total = total_weight(pool);
  double mean = 0;
  for (const RoutedTrip& trip : pool.trips) mean += trip.length * trip.weight / total;
  return mean;
}

double mean_duration(const TripPool& pool) { return mean_time(pool, &RoutedTrip::duration); }

double mean_inside(const TripPool& pool) { return mean_time(pool, &RoutedTrip::inside); }

BusiestLane weigh_trips(const RoadNetwork& road, std::vector<TripPool>& pools) {
  std::vector<double> load(road.lanes.size());
  for (int round = 0; round < kRounds; ++round) {
    load = lane_loads(road, flows(road, pools, load));
    for (TripPool& pool : pools) {
      if (pool.fixed) continue;
      for (RoutedTrip& trip : pool.trips) {
        // the root: others on the same lane give way as well
        trip.weight /= std::sqrt(std::max(1.0, worst_load(road, trip, load) / kAim));
        trip.weight = std::max(trip.weight, kRarest);
      }
      restore_lengths(pool.trips);
    }
  }
  return busiest_lane(road, pools, load);
}

BusiestLane busiest_lane(const RoadNetwork& road, const std::vector<TripPool>& pools,
                         std::vector<double> load) {
  load.resize(road.lanes.size());
  load = lane_loads(road, flows(road, pools, load));
  BusiestLane busiest;
  for (std::size_t i = 0; i < load.size(); ++i)
    if (load[i] > busiest.load) busiest = {LaneId(static_cast<int>(i)), load[i]};
  return busiest;
}

}  // namespace sumogamma
