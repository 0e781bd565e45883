#pragma once

#include "road/path.h"
#include "road/road_network.h"

namespace sumogamma {

/// Bounds the room beside a walk over walking areas by their outlines, which are kerbs but for
/// where lanes on foot begin: splits their stretches into pieces of a metre, each with the room at
/// its middle, `least` at the least [m]. Where the path lies outside of the area its room stays as
/// it is.
void bound_walking_areas(const RoadNetwork& network, double least, Path& path);

}  // namespace sumogamma
