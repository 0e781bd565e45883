#pragma once

#include <string>
#include <vector>

#include "demand/class_graph.h"
#include "demand/demand.h"
#include "demand/trip_weights.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// Edges between which somebody travels.
struct TripEnds {
  std::size_t from = 0, to = 0;
  std::size_t via = kNowhere;  ///< an edge that it has to lead over
  double weight = 1;           ///< of its trip (RoutedTrip)
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);
};

/// Everything about one type while demand is made.
struct TypeDemand {
  const AgentType* type = nullptr;
  bool walks = false;
  ClassGraph graph;
  std::vector<TripEnds> drawn;
  TripPool pool;  ///< of those that the router found ways for
  DemandByType report;
};

/// Do its agents differ in the speed that they like (people on foot and on bicycles), rather than
/// in how they take the limit?
inline bool has_own_pace(const AgentType& type) {
  return type.sumo_class == "pedestrian" || type.sumo_class == "bicycle";
}

}  // namespace sumogamma
