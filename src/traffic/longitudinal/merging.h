#pragma once

#include "road/path.h"
#include "scene/agent_type.h"
#include "traffic/parameters.h"

namespace sumogamma {

/// One of two vehicles whose ways come together in a lane.
struct Merging {
  const AgentType& type;
  const Path& path;
  double front = 0;            ///< along its path [m]
  double length = 0;           ///< [m]
  double speed = 0;            ///< along its path [m/s]
  double preferred_speed = 0;  ///< [m/s]
  double merged = 0;           ///< along its path, a place that both ways have in common [m]
};

/// Hardest braking [m/s^2] that who comes along a lane is forced to over the merging_outlook by
/// another who goes first: both are rolled out along their paths as fast as those let them, the
/// other behind the entrant after the Intelligent Driver Model from when that one's front is past
/// `in_the_way` [m along its path]. This is the safety criterion of MOBIL (Kesting et al. 2007)
/// taken over time, because who turns in from a halt is slow for seconds. 0 where nobody has to
/// brake; infinite where they would touch.
double braking_asked(const TrafficParameters& parameters, Merging entrant, double in_the_way,
                     Merging oncomer);

}  // namespace sumogamma
