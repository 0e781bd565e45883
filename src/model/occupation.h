#pragma once

#include <limits>

#include "model/right_of_way.h"

namespace sumogamma {

/// When a body is inside a piece of a link's way [s from now].
struct Occupation {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  double begin = 0, end = 0;  ///< both never where its rear has passed; who stands in it stays
};

/// From when the front gets to `begin` until the rear has left `end` [m past the link's begin], on
/// the way up to `top_speed` [m/s].
Occupation occupation(const AgentType& type, const Approach& who, double begin, double end,
                      double top_speed);

/// That a row with a path could drive where it is: what its path and its type leave [m/s].
double top_speed(const Model& model, const RoadState& road, const Scene& scene, std::size_t row);

/// A traveller as those see it who come by other links.
Approach approach_of(const Traveller& traveller, const PathLink& link);

}  // namespace sumogamma
