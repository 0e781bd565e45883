#pragma once

#include "road/path.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// Who drives into a lane on which others come.
struct Entrant {
  const AgentType& type;
  const Path& path;
  double front = 0;            ///< along its path [m]
  double length = 0;           ///< [m]
  double speed = 0;            ///< along its path [m/s]
  double preferred_speed = 0;  ///< [m/s]
  double in_the_way = 0;       ///< along its path, from where on its front is in the way [m]
  double merged = 0;           ///< along its path, a place that both ways have in common [m]
};

/// Who comes along the lane.
struct Oncomer {
  const AgentType& type;
  double to_merged = 0;   ///< its front's way to the common place [m]
  double speed = 0;       ///< [m/s]
  double free_speed = 0;  ///< that it would drive alone [m/s]
};

/// Hardest braking [m/s^2] that who comes along a lane is forced to over the next 10 s by another
/// who goes first: both are rolled out, the entrant along its path as fast as that lets it, the
/// other behind it after the Intelligent Driver Model from when it is in the way. This is the
/// safety criterion of MOBIL (Kesting et al. 2007) taken over time, because who turns in from a
/// halt is slow for seconds. 0 where nobody has to brake; infinite where they would touch.
double braking_asked(Entrant entrant, Oncomer oncomer);

}  // namespace sumogamma
