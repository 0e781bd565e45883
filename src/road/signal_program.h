#pragma once

#include <cstddef>
#include <optional>

#include "road/road_network.h"
#include "road/sumo_letters.h"

namespace sumogamma {

/// What a signal's program shows at a time.
struct ProgramPlace {
  std::size_t phase = 0;  ///< index in the signal's phases
  double since = 0;       ///< when that began [s]
};

/// Where a program of fixed phases is at `time` [s], if its first phase began at time 0 and it goes
/// round for ever; nullopt of a signal without phases or whose phases last no time.
std::optional<ProgramPlace> program_at(const Signal& signal, double time);

/// What the program of a connection's signal shows it at `time` [s], as program_at; None where it
/// has no signal, or a program that tells nothing of it.
Light light_by_program(const RoadNetwork& network, const Connection& connection, double time);

}  // namespace sumogamma
