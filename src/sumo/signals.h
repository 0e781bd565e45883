#pragma once

#include <vector>

#include "road/road_network.h"
#include "scene/road_state.h"
#include "sumo/backend.h"

namespace sumogamma {

/// The network's signals in the order of the back end's list; kNoSignal: not of the network.
std::vector<SignalId> signals_in_order(const RoadNetwork& network, const SumoBackend& backend);

/// Puts what the signals show after `step` into the road's state, with when they changed and when
/// an amber that has begun ends.
void show_signals(const std::vector<SignalId>& order, const SumoStep& step, double now,
                  SumoBackend& backend, RoadState& road);

}  // namespace sumogamma
