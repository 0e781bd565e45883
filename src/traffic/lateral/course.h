#pragma once

#include "traffic/traffic_view.h"

namespace sumogamma {

/// One row's view of its path at this instant.
struct Course : EgoOnPath {
  const Path& path;
  const AgentType& type;
  std::size_t row;
  double headway_factor;
};

/// Where the agent wants to go and what is free to its sides: tangent, sub-goal, bend and rooms of
/// its context. How fast it may go is road_context's.
void set_geometry(const TrafficView& view, const Course& course, RoadContext& context);

}  // namespace sumogamma
