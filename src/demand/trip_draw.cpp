#include "demand/trip_draw.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "demand/draws.h"

namespace sumogamma {
namespace {

constexpr double kRimPreference =
    10.0;  // how much likelier a trip starts or ends at the network's rim
constexpr std::size_t kOrigins = 200;  // distinct origins of a type, each searched once
constexpr long kPoolTotal = 2500;  // routed trips, shared out by type; departures draw from them
constexpr long kPoolLeast = 120;

/// Draws origin-destination pairs: both by edge length, the rim preferred, at least so far apart.
/// Trips begin and end on the same edge only where that stands alone, or all may with
/// `within_edge`. An edge that stands alone counts by its length: preferred as rim, 200 m of road
/// that a cut-out had left joined to nothing took every fifth car of a map.
class TripDraw {
 public:
  TripDraw(const TypeDemand& demand, std::uint64_t seed, std::uint64_t stream, double min_distance,
           bool within_edge)
      : graph_(demand.graph),
        walks_(demand.walks),
        within_edge_(within_edge),
        draws_(seed, stream),
        least_edge_(demand.walks ? 2.0 : demand.type->length + 3.0) {
    std::vector<double> cumulative;
    std::vector<std::size_t> candidates;
    double total = 0;
    for (const std::size_t edge : graph_.edges) {
      if (graph_.length[edge] < least_edge_) continue;
      const bool rim = graph_.entries[edge] == 0 && !graph_.stands_alone(edge);
      total += graph_.length[edge] * (rim ? kRimPreference : 1.0);
      cumulative.push_back(total);
      candidates.push_back(edge);
    }
    // every other origin may lie at a dead end of the cut-out: ask more often than origins are
    // wanted
    for (std::size_t attempt = 0;
         !candidates.empty() && attempt < 3 * kOrigins && origins_.size() < kOrigins; ++attempt)
      add_origin(candidates[draws_.weighted(cumulative)], min_distance);
  }
  bool empty() const { return origins_.empty(); }
  TripEnds draw() {
    const Origin& origin = origins_[draws_.index(origins_.size())];
    return {origin.edge, origin.targets[draws_.weighted(origin.cumulative)]};
  }

 private:
  struct Origin {
    std::size_t edge = 0;
    std::vector<std::size_t> targets;
    std::vector<double> cumulative;
  };
  void add_origin(std::size_t edge, double min_distance) {
    if (const auto known = searched_.find(edge); known != searched_.end()) {
      if (known->second < origins_.size()) origins_.push_back(Origin(origins_[known->second]));
      return;
    }
    const std::vector<double> distance = distances_from(graph_, edge);
    Origin origin{edge, {}, {}};
    double total = 0;
    for (const std::size_t target : graph_.edges) {
      if (graph_.length[target] < least_edge_) continue;
      if (target == edge && (walks_ || !(within_edge_ || graph_.stands_alone(edge)))) continue;
      if (!(distance[target] >= min_distance) || distance[target] == kUnreachable) continue;
      const bool rim = graph_.next[target].empty();
      total += graph_.length[target] * (rim ? kRimPreference : 1.0);
      origin.targets.push_back(target);
      origin.cumulative.push_back(total);
    }
    searched_[edge] =
        origin.targets.empty() ? std::numeric_limits<std::size_t>::max() : origins_.size();
    if (!origin.targets.empty()) origins_.push_back(std::move(origin));
  }
  const ClassGraph& graph_;
  bool walks_, within_edge_;
  DemandDraws draws_;
  double least_edge_;
  std::vector<Origin> origins_;
  std::map<std::size_t, std::size_t> searched_;
};

/// A type's trips, as far apart as the map allows; within one edge only where there are no others,
/// or the router refused all of them.
std::vector<TripEnds> draw_type(const TypeDemand& demand, std::uint64_t seed, std::uint64_t stream,
                                double min_distance, long count) {
  std::vector<TripEnds> trips;
  const bool refused = demand.report.trips_drawn > 0 && demand.pool.trips.empty();
  for (double distance = min_distance; distance > 5.0; distance /= 2)
    for (const bool within_edge : {refused, true}) {
      TripDraw draw(demand, seed, stream, distance, within_edge);
      if (draw.empty()) continue;
      for (long k = 0; k < count; ++k) trips.push_back(draw.draw());
      return trips;
    }
  return trips;
}

}  // namespace

void draw_trips(std::vector<TypeDemand>& types, std::uint64_t seed, double min_distance,
                int round) {
  double total = 0;
  for (const TypeDemand& demand : types) total += demand.report.share;
  for (std::size_t i = 0; i < types.size(); ++i) {
    TypeDemand& demand = types[i];
    if (demand.pool.fixed) continue;
    const long wanted = std::max(
        kPoolLeast, std::lround(static_cast<double>(kPoolTotal) * demand.report.share / total));
    const long missing = wanted - static_cast<long>(demand.pool.trips.size());
    demand.drawn = draw_type(demand, seed, static_cast<std::uint64_t>(round) * 100 + i,
                             min_distance, std::max(missing, 0L));
    demand.report.trips_drawn += static_cast<long>(demand.drawn.size());
  }
}

void draw_trips_over(std::size_t edge, std::uint64_t seed, TypeDemand& demand) {
  constexpr int kTrips = 10, kAttempts = 200;
  constexpr double kDetour = 1.3;  // length over that of the shortest way
  const ClassGraph& graph = demand.graph;
  if (demand.walks || demand.pool.fixed || !graph.usable[edge]) return;
  const std::vector<double> onwards = distances_from(graph, edge);
  DemandDraws draws(seed, 2000 + edge);
  int found = 0;
  for (int attempt = 0; attempt < kAttempts && found < kTrips; ++attempt) {
    const std::size_t from = graph.edges[draws.index(graph.edges.size())];
    if (graph.length[from] < demand.type->length + 3.0) continue;
    const std::vector<double> distance = distances_from(graph, from);
    if (distance[edge] == kUnreachable) continue;
    std::vector<std::size_t> targets;
    std::vector<double> cumulative;
    double total = 0;
    for (const std::size_t to : graph.edges) {
      const double way = distance[edge] - graph.length[edge] + onwards[to];
      if (onwards[to] == kUnreachable || to == from || way > kDetour * distance[to]) continue;
      total += graph.length[to] * (graph.next[to].empty() ? kRimPreference : 1.0);
      targets.push_back(to);
      cumulative.push_back(total);
    }
    if (targets.empty()) continue;
    demand.drawn.push_back({from, targets[draws.weighted(cumulative)], edge});
    ++demand.report.trips_drawn;
    ++found;
  }
}

}  // namespace sumogamma
