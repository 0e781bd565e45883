#pragma once

#include "traffic/traffic_tick.h"

namespace sumogamma {

/// Counts how far a row has driven without getting on along its path, on which it was at `before`
/// [m] a tick ago.
void note_progress(const TrafficParameters& parameters, double before, double dt,
                   const Scene& scene, TrafficState& traffic, std::size_t row);

/// Drivers who have lost their way get one: who has driven for soon_way though its place on its
/// path stood still, be it that the path leads where the body can't, goes on from the nearest place
/// ahead on its path that leads its way, else from the nearest lane that does and leads to its
/// destination. Serial, in order of row.
void find_ways_back(const TrafficTick& tick);

}  // namespace sumogamma
