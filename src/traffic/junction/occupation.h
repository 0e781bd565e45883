#pragma once

#include <limits>

#include "traffic/junction/arbitration.h"

namespace sumogamma {

/// When a body is inside a piece of a link's way [s from now].
struct Occupation {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  double begin = 0, end = 0;  ///< both never where its rear has passed; who stands in it stays
};

/// From when the front of a row with a path gets to `begin` until its rear has left `end` [m past
/// the link's begin, as `who.front`], as fast as its path, its type and its liking let it.
Occupation occupation(const TrafficView& view, const Approach& who, double begin, double end);

/// How somebody drives on.
struct Pace {
  double speed = 0;         ///< now [m/s]
  double most = 0;          ///< besides its speed profile [m/s]
  double acceleration = 0;  ///< with which it takes up speed [m/s^2]
};

/// Time [s] in which somebody gets from one place of its path to another [m along it, of its
/// middle], read every parameters.path_step.
double time_to_drive(const TrafficParameters& parameters, const Path& path, double from, double to,
                     Pace pace);

/// A traveller as those see it who come by other links.
Approach approach_of(const Traveller& traveller, const PathLink& link);

}  // namespace sumogamma
