#pragma once

#include "traffic/traffic_view.h"

namespace sumogamma {

/// Does this agent go over a link that shows red, once it has halted and where the way is free?
/// Drawn once for an agent and an approach (or crossing, on foot), whichever of its lanes it takes.
/// Everybody does at an inner signal: who got green at the outer one clears the junction; and on
/// wheels where the law has turns on red (admits_turn_on_red).
bool goes_at_red(const TrafficView& view, std::size_t row, ConnectionId link);

/// Does this agent let people go first who wait at an unsignalled crossing? Drawn once for an agent
/// and a crossing. True for everybody on foot.
bool lets_people_go(const Model& model, const Scene& scene, std::size_t row, ConnectionId crossing);

/// Does this agent, first at a red light, roll on over its line? Drawn once for an agent and an
/// approach.
bool creeps(const TrafficView& view, std::size_t row, ConnectionId link);

/// Does this agent take a stop sign's line for one to give way at, at which it needn't halt? Drawn
/// once for an agent and an approach. False where the link has no stop sign, or a signal.
bool rolls_over(const TrafficView& view, std::size_t row, ConnectionId link);

}  // namespace sumogamma
