#pragma once

#include "geometry/oriented_box.h"
#include "model/tick_geometry.h"
#include "scene/road_context.h"

namespace sumogamma {

/// How an agent's way bends with its path over the next kBendTime, taken for an arc.
struct Arc {
  const AgentGeometry& agent;
  double curvature;  ///< [1/m], positive left

  /// `bend` as in RoadContext.
  Arc(const AgentGeometry& agent, const Vec2& bend);
  /// The body with the margins that avoidance keeps, `way` [m] on from here.
  OrientedBox body_after(double way) const;
};

/// Do two who keep to their arcs at these speeds [m/s] stay apart for `time` [s]?
bool bend_past(const Arc& a, double speed_a, const Arc& b, double speed_b, double time);

}  // namespace sumogamma
