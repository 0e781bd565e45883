#pragma once

#include "road/path.h"

namespace sumogamma {

/// Fills path.speed_profile from lane limits and curvature (v^2 kappa <= lateral acceleration),
/// then brakes backwards with the comfortable deceleration, by ramps. Curvature is the mean turning
/// over the way that the steering takes, so that a map's kinks are spread as drivers do.
void compute_speed_profile(const PathRequest& request, Path& path);

}  // namespace sumogamma
