#pragma once

#include <string>
#include <vector>

namespace sumogamma {

struct TripPool;

/// Vehicles counted on an edge, or turning from it onto another.
struct EdgeCount {
  std::string edge, to;  ///< `to` is empty where all of the edge were counted
  double per_hour = 0;
};

/// What trips make of a count.
struct CountFit {
  EdgeCount count;
  double per_hour = 0;  ///< by the trips
  /// G. E. Havers' statistic of two flows an hour; under 5 they agree well (FHWA, Traffic Analysis
  /// Toolbox III).
  double geh = 0;
};

double geh(double modelled, double counted);

/// Changes how often vehicles' trips are driven until the flows on the counted edges are those
/// counted: iterative proportional fitting (Deming and Stephan 1940), which stays as near as it can
/// to the trips as drawn; and with it how many agents of a pool are alive (Little's law). Pools
/// that are fixed (TripPool) stay and count.
std::vector<CountFit> fit_counts(const std::vector<EdgeCount>& counts,
                                 std::vector<TripPool*>& vehicles);

}  // namespace sumogamma
