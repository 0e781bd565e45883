#pragma once

#include <cstdint>
#include <string>

#include "realism/free_run.h"
#include "realism/road_loop.h"

namespace sumogamma {

/// SUMO's own drivers in a free run: the recording as the demand that `scene-from --map` writes, by
/// the models of SumoLoop. SUMO inserts everybody when it finds room; signals are the network's.
/// Throws Error with what SUMO says where it fails.
FreeRun drive_sumo_freely(const RecordedScene& scene, const RecordedRoad& road,
                          const std::string& method, std::uint64_t seed);

}  // namespace sumogamma
