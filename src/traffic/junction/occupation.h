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

/// Time [s] in which somebody at `speed` [m/s] gets from one place of its path to another [m along
/// it, of its middle], as its speed profile and `most` [m/s] let it, taking up speed with
/// `acceleration` [m/s^2].
double time_to_drive(const Path& path, double from, double to, double speed, double most,
                     double acceleration);

/// A traveller as those see it who come by other links.
Approach approach_of(const Traveller& traveller, const PathLink& link);

}  // namespace sumogamma
