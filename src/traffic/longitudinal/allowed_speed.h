#pragma once

#include "traffic/lateral/course.h"
#include "traffic/longitudinal/stop_points.h"

namespace sumogamma {

/// The profile's speed with some time to reach it [m/s]: who follows a line of short straight
/// pieces, aside of it, gets on along it by jumps. dt [s].
double foreseen_limit(const TrafficParameters& parameters, const Path& path, double along,
                      double speed, double dt);

/// How fast a driver may be after a tick of dt [s], and why: sets allowed_speed, reason, foe,
/// to_halt and at_red of its context, whose speed_limit and sub_goal are known. `found` is scratch.
void set_allowed_speed(const TrafficView& view, const Course& course, double dt, StopPoints& found,
                       RoadContext& context);

}  // namespace sumogamma
