#pragma once

#include <cstdint>

#include "traffic/traffic_tick.h"

namespace sumogamma {

/// Drivers whose way is shut take another one: who has stood for long before a full road, or for a
/// gap into the lane that its route needs, goes on from its own lane by the fastest route to its
/// destination, as the roads are now, where there is room at its begin. Who waits for a gap though
/// its lane leads on along its route keeps that lane instead. Buses and other long bodies do
/// neither; who has stops to serve keeps its route. Serial, and in order of row; returns how many
/// took another route.
std::uint64_t take_detours(const TrafficTick& tick);

}  // namespace sumogamma
