#pragma once

#include "road/path.h"
#include "road/road_network.h"

namespace sumogamma {

/// Bounds the room beside a walk over walking areas by their outlines, which are kerbs but for
/// where lanes on foot begin: splits their stretches into pieces of a metre, each with the room at
/// its middle, `least` at the least [m]. Areas between which netconvert left less than a metre of
/// road are one: that road is no narrower than they are. Where the path lies outside of the areas
/// its room stays as it is.
void bound_walking_areas(const RoadNetwork& network, double least, Path& path);

}  // namespace sumogamma
