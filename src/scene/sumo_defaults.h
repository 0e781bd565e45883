#pragma once

#include <algorithm>

namespace sumogamma {

/// SUMO's default desiredMaxSpeed of pedestrians, 5 km/h [m/s] (its vType documentation, "Default
/// Values"). TraCI does not tell the desiredMaxSpeed of a type, only its maxSpeed, which is that of
/// a sprinter.
inline constexpr double kWalkingSpeed = 5.0 / 3.6;

/// A person's walking speed before its speed factor, from the maxSpeed that SUMO tells [m/s].
constexpr double walking_speed(double max_speed) { return std::min(max_speed, kWalkingSpeed); }

/// SUMO's default desiredMaxSpeed of bicycles, 20 km/h [m/s] (same page).
inline constexpr double kCyclingSpeed = 20.0 / 3.6;

}  // namespace sumogamma
