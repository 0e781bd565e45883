#pragma once

#include "scene/agent_type.h"

namespace sumogamma {

/// Acceleration of the Intelligent Driver Model [m/s^2] (Treiber, Hennecke, Helbing 2000), within
/// the type's limits: towards `free_speed` behind something `gap` metres ahead that moves at
/// `leader_speed`. gap may be infinite (free road) or <= 0 (brakes fully). This shapes the
/// contextual speed limit of an agent in a lane; avoidance stays GAMMA's. `headway_factor` is the
/// agent's own on its type's headway.
double following_acceleration(const AgentType& type, double speed, double free_speed, double gap,
                              double leader_speed, double headway_factor = 1.0);

/// Deceleration needed to stop within `distance` [m/s^2]; infinite where there is none left.
double deceleration_to_stop(double speed, double distance);

/// Time to cover `distance` [s] from `speed`, accelerating to `top_speed`; 0 for distance <= 0.
double time_to_cover(double distance, double speed, double top_speed, double acceleration);

}  // namespace sumogamma
