#pragma once

#include <cstdint>

#include "demand/type_demand.h"

namespace sumogamma {

/// Draws trips for each type, as many as a pool of a few thousand still lacks, into `drawn`. Both
/// ends are drawn by edge length, the network's rim preferred, at least `min_distance` [m] apart or
/// as far as the map allows; within one edge only where a type has no others, or the router refused
/// all of them. `round` counts the calls.
void draw_trips(std::vector<TypeDemand>& types, std::uint64_t seed, double min_distance, int round);

/// Adds trips of a type that lead over an edge without going much out of their way; nothing where
/// it can't be there.
void draw_trips_over(std::size_t edge, std::uint64_t seed, TypeDemand& demand);

}  // namespace sumogamma
