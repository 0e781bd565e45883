#pragma once

#include "scene/agent_type.h"
#include "traffic/parameters.h"

namespace sumogamma {

/// Time gap that a driver wants at a speed [s]: the type's headway from its full_headway_speed on,
/// less in a queue, where drivers close up, so that a lane discharges at the same rate however slow
/// it gets over the line (HCM 2010, ch. 31: the saturation headway holds from the fourth vehicle
/// on). The same at every speed where the type says so.
double kept_headway(const AgentType& type, double speed);

/// Share of that which a driver keeps `since_standing` seconds after it last stood: all of it out
/// of a queue, less in traffic that flows. Drivers in dense free traffic follow at about a second,
/// those who come out of a jam at more, and it takes them a while to forget it (Treiber, Helbing
/// 2003, "Memory effects in microscopic traffic models"): capacity drops where a road breaks down.
double headway_memory(const TrafficParameters& parameters, double since_standing);

/// Acceleration of the Intelligent Driver Model [m/s^2] (Treiber, Hennecke, Helbing 2000; exponent
/// 8), within the type's limits: towards `free_speed` behind something `gap` metres ahead that
/// moves at `leader_speed`. gap may be infinite (free road) or <= 0 (brakes fully). This shapes the
/// contextual speed limit of an agent in a lane; avoidance stays GAMMA's. Its time gap is
/// kept_headway times `headway_factor`, the agent's own.
double following_acceleration(const AgentType& type, double speed, double free_speed, double gap,
                              double leader_speed, double headway_factor = 1.0);

/// Somebody who is followed.
struct Followed {
  double gap = 0;           ///< to its rear [m]
  double speed = 0;         ///< [m/s]
  double acceleration = 0;  ///< [m/s^2]
};

/// Braking that keeps a body at `speed` off somebody who brakes on as now, >= 0 [m/s^2]: the
/// constant-acceleration heuristic (Kesting, Treiber, Helbing 2010, Eq. 11). Nobody counts on
/// another to speed up.
double braking_behind(double speed, const Followed& followed);

/// Acceleration behind somebody who drives [m/s^2]: following_acceleration where that brakes no
/// harder than braking_behind, and else no harder than this by the comfortable deceleration (the
/// ACC model of the same paper, Eqs. 12-13, coolness 0.99). The plain model brakes like for a wall
/// when somebody cuts in, however fast that one drives; this lets the gap open at ease.
double behind_acceleration(const AgentType& type, double speed, double free_speed,
                           const Followed& followed, double headway_factor = 1.0);

/// Deceleration needed to stop within `distance` [m/s^2]; infinite where there is none left.
double deceleration_to_stop(double speed, double distance);

/// Time to cover `distance` [s] from `speed`, accelerating to `top_speed`; 0 for distance <= 0.
double time_to_cover(double distance, double speed, double top_speed, double acceleration);

}  // namespace sumogamma
