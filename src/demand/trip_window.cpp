#include "demand/trip_window.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

/// Of an edge's length, looked at every few metres.
double share_inside(const RoadNetwork& road, const TripWindow& window, EdgeId edge) {
  constexpr double kEvery = 5.0;  // [m]
  const Polyline& line = road.lane(road.edge(edge).lanes.front()).centerline;
  const int parts = std::max(1, static_cast<int>(std::ceil(line.length() / kEvery)));
  int inside = 0;
  for (int part = 0; part < parts; ++part) {
    const Vec2 at = line.point_at((part + 0.5) * line.length() / parts);
    inside +=
        (at.array() >= window.lower.array()).all() && (at.array() <= window.upper.array()).all();
  }
  return static_cast<double>(inside) / parts;
}

}  // namespace

void keep_trips_through(const RoadNetwork& road, const TripWindow& window, TypeDemand& demand) {
  std::vector<double> shares(road.edges.size(), -1.0);
  for (RoutedTrip& trip : demand.pool.trips) {
    trip.inside = 0;
    for (std::size_t i = 0; i < trip.edges.size(); ++i) {
      const EdgeId edge = road.edge_by_name.at(trip.edges[i]);
      double& share = shares[index_of(edge)];
      if (share < 0) share = share_inside(road, window, edge);
      trip.inside += share * trip.times[i];
    }
  }
  std::erase_if(demand.pool.trips, [](const RoutedTrip& trip) { return trip.inside <= 0; });
}

}  // namespace sumogamma
