#pragma once

#include "geometry/convex_polygon.h"
#include "scene/footprint.h"

namespace sumogamma {

/// One of two bodies as surrogate measures of safety see it.
struct MovingBody {
  Footprint footprint;           ///< body axes about the centre [m]
  Vec2 position = Vec2::Zero();  ///< of the centre [m]
  double heading = 0;            ///< [rad]
  Vec2 velocity = Vec2::Zero();  ///< of the centre [m/s]
  double turn_rate = 0;          ///< of heading and velocity alike, positive left [rad/s]
};

/// Where the body is after `time` [s] at constant speed and turn rate: on an arc of a circle, or
/// straight ahead.
MovingBody moved(const MovingBody& body, double time);

/// Shortest distance of the two outlines [m]; 0 where they touch or overlap.
double outline_gap(const MovingBody& a, const MovingBody& b);

/// Time to collision (Hayward 1972, "Near-miss determination through use of a scale of danger"):
/// how long until the outlines touch if both go on with the speed and turn rate that they have [s].
/// In two dimensions for any two outlines and directions; of two in one lane it is their gap over
/// the difference of their speeds. 0 where they touch already. Infinite where they don't within
/// `horizon` [s]. Straight ahead in closed form (the ray along the relative velocity against
/// B - A), on arcs by conservative advancement to 1 mm.
double time_to_collision(const MovingBody& a, const MovingBody& b, double horizon);

/// Deceleration rate to avoid a crash (Cooper and Ferguson 1976; Almqvist et al. 1991), of the
/// motion relative to each other: w^2 / (2 w TTC) for a relative speed w, which in one lane is
/// (difference of speeds)^2 / (2 gap) [m/s^2]. 0 where the time is infinite, infinite where it is
/// 0.
double deceleration_to_avoid(double relative_speed, double time_to_collision);

/// The same, begun only after a reaction (Kuang, Qu and Wang 2015, "modified DRAC"):
/// w / (2 (TTC - reaction)); infinite where the reaction takes as long [m/s^2]. SUMO's SSM device
/// takes a reaction of 1 s.
double modified_deceleration_to_avoid(double relative_speed, double time_to_collision,
                                      double reaction = 1.0);

}  // namespace sumogamma
