#pragma once

#include "geometry/polyline.h"
#include "planning/wheeled_pose.h"

namespace sumogamma {

/// How an ego follows its way, and what counts as in its way.
struct EgoControl {
  double look_ahead = 5.0;                       ///< of pure pursuit [m]
  double top_speed = 6.0;                        ///< [m/s]
  double front_margin = 3.0, side_margin = 0.8;  ///< boxes are widened by, in front and elsewhere
                                                 ///< [m]
  double cone = 1.0471975511965976;              ///< what is ahead: to each side [rad]
};

/// Front wheel angle [rad, positive left] that leads the rear axle on an arc to the point of the
/// way `look_ahead` [m] on from its own place there (R. C. Coulter, 1992), within the lock.
double pursuit_steering(const WheeledShape& shape, const AxlePose& pose, const Polyline& way,
                        double along, double look_ahead);

/// Velocity of the body's centre [m/s] whose rear axle rolls at `speed` with the wheels so: what
/// the body's own controller (advance_body) is asked for.
Vec2 rolling_velocity(const WheeledShape& shape, const AxlePose& pose, double speed,
                      double steering);

/// Is a body with its margins in touch with another one ahead of it? Margins are the ego's: in
/// front, to the sides and behind; ahead is within the cone about its heading from its middle.
bool is_in_the_way(const OrientedBox& ego, const OrientedBox& other, const EgoControl& control);

}  // namespace sumogamma
